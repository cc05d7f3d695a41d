// The kernels for processors with AVX-512; as line_kernels_avx2.cpp.
#include "line_kernels.h"

namespace backlight {

LineKernels avx512_line_kernels() {
#if defined(__AVX512DQ__)
  return line_kernels<8>();
#else
  return {};
#endif
}

}  // namespace backlight
