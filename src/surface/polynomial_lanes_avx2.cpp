// Compiled with -mavx2; to be called only where the processor has it.
#include "polynomial_lanes.h"

namespace backlight {

PolynomialKernels polynomial_kernels_avx2(int degree) {
  return PolynomialLanesOfAnyDegree<4>::of(degree);
}

}  // namespace backlight
