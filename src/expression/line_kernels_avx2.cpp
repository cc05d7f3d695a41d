// The kernels for processors with AVX2; compiled with -mavx2, and called only where the processor has it.
#include "line_kernels.h"

namespace backlight {

LineKernels avx2_line_kernels() {
#if defined(__AVX2__)
  return line_kernels<4>();
#else
  return {};
#endif
}

}  // namespace backlight
