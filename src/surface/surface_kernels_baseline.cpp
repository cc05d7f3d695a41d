// The kernels for the instructions that every machine of its kind has: two lanes. And which ones are taken.
#include "backlight/base/instruction_sets.h"
#include "surface_kernels.h"

namespace backlight {
namespace {

SurfaceKernels kernels_of(InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::widest && has_good_avx512()) return avx512_surface_kernels();
  if (set != InstructionSet::baseline && has_avx2()) return avx2_surface_kernels();
#endif
  return baseline_surface_kernels();
}

}  // namespace

SurfaceKernels baseline_surface_kernels() {
  return surface_kernels_of<Lanes<2>>();
}

const SurfaceKernels& surface_kernels(InstructionSet set) {
  static const SurfaceKernels kernels[] = {kernels_of(InstructionSet::widest),
                                           kernels_of(InstructionSet::avx2),
                                           kernels_of(InstructionSet::baseline)};
  return kernels[static_cast<int>(set)];  // in the order of the enumeration
}

}  // namespace backlight
