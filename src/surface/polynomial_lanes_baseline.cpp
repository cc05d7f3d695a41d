#include "polynomial_lanes.h"

namespace backlight {

PolynomialKernels polynomial_kernels_baseline(int degree) {
  return PolynomialLanesOfAnyDegree<2>::of(degree);
}

}  // namespace backlight
