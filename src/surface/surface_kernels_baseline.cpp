// The kernels for the instructions that every machine of its kind has: two lanes. And which ones are taken.
#include "backlight/base/instruction_sets.h"
#include "surface_kernels.h"

namespace backlight {
namespace {

SurfaceKernels widest() {
#if defined(__x86_64__)
  if (has_good_avx512()) return avx512_surface_kernels();
  if (has_avx2()) return avx2_surface_kernels();
#endif
  return baseline_surface_kernels();
}

}  // namespace

SurfaceKernels baseline_surface_kernels() {
  return surface_kernels_of<Lanes<2>>();
}

const SurfaceKernels& surface_kernels() {
  static const SurfaceKernels kernels = widest();
  return kernels;
}

}  // namespace backlight
