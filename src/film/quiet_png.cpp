// In libbacklight_oiio.so: libpng writes nothing to stderr.
//
// OpenImageIO 2.4 notes libpng's errors and returns from its handler, which libpng takes as a wish for its
// own: a line on stderr, and a jump to where the caller waits for it. The function by which OpenImageIO sets
// its handler is found here first, since this module comes before libpng in the order of symbols; it passes
// on to libpng's, with a handler that jumps by itself.
#include <dlfcn.h>

namespace {

// Of libpng's interface, stable since 1.5 (png.h, which building needs in no other place).
using Report = void (*)(void* reader, const char* text);
using Set = void (*)(void* reader, void* data, Report error, Report warning);
using Jump = void (*)(void* reader, int value);

thread_local Report noting = nullptr;  // a picture is read by the thread that opens it

template <typename Function>
Function next_of(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

void note_and_jump(void* reader, const char* text) {
  noting(reader, text);
  static const auto jump = next_of<Jump>("png_longjmp");
  jump(reader, 1);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void png_set_error_fn(void* reader, void* data,
                                                                        Report error, Report warning) {
  static const auto set = next_of<Set>("png_set_error_fn");
  if (error == nullptr || error == note_and_jump) return set(reader, data, error, warning);
  noting = error;
  set(reader, data, note_and_jump, warning);
}
