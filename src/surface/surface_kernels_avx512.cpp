// The kernels for AVX-512: eight lanes.
#include "surface_kernels.h"

namespace backlight {

SurfaceKernels avx512_surface_kernels() {
  return surface_kernels_of<Lanes<8>>();
}

}  // namespace backlight
