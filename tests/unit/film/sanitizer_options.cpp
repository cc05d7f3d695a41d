// Defaults for the sanitizers, which call these functions by name. Without a sanitizer nobody does.

extern "C" {

/// OpenImageIO leaves libpng's errors by longjmp, past the destructor of a string.
const char* __lsan_default_suppressions() {
  return "leak:libOpenImageIO";
}

/// A false race is reported inside OpenImageIO, which is not instrumented, while it is loaded.
const char* __tsan_default_options() {
  return "ignore_noninstrumented_modules=1";
}
}
