// The kernels for AVX2: four lanes.
#include "surface_kernels.h"

namespace backlight {

SurfaceKernels avx2_surface_kernels() {
  return surface_kernels_of<Lanes<4>>();
}

}  // namespace backlight
