// Compiled for AVX-512; to be called only where the processor has it.
#include "polynomial_lanes.h"

namespace backlight {

PolynomialKernels polynomial_kernels_avx512(int degree) {
  return PolynomialLanesOfAnyDegree<8>::of(degree);
}

}  // namespace backlight
