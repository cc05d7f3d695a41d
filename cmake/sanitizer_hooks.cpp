// What the sanitizers' runtimes ask a program for, by the names of these functions. Part of every executable
// of a sanitized build (BacklightCompiler.cmake).
#include <link.h>

#include <cstddef>
#include <cstring>

// Names that the runtimes reserve for this.
extern "C" {

int __lsan_is_turned_off();
const char* __tsan_default_options();

/// Asked when the process ends: whether leaks are not looked for. OpenImageIO, loaded on demand
/// (film/image_module.h), keeps what it allocated, leaves libpng's errors by longjmp past destructors, and
/// brings libraries of whose thread-local storage the search for leaks knows too little.
int __lsan_is_turned_off() {
  const auto is_openimageio = [](dl_phdr_info* object, std::size_t /*size*/, void* /*data*/) {
    return std::strstr(object->dlpi_name, "libOpenImageIO") != nullptr ? 1 : 0;
  };
  return dl_iterate_phdr(is_openimageio, nullptr);
}

/// A false race is reported inside OpenImageIO, which is not instrumented, while it is loaded.
const char* __tsan_default_options() {
  return "ignore_noninstrumented_modules=1";
}
}
