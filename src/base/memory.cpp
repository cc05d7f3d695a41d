#include "backlight/base/memory.h"

#include <cstdlib>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace backlight {

void return_freed_memory(std::size_t bytes) {
  if (bytes < std::size_t{1} << 20U) return;
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace backlight
