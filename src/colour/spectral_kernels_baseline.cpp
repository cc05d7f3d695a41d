// The kernels for the instructions that every machine of its kind has (SSE2, NEON): two lanes.
#include "spectral_kernel_templates.h"

namespace backlight {

#if defined(__x86_64__)
const SpectralKernels& avx2_spectral_kernels();
const SpectralKernels& avx512_spectral_kernels();
#endif

const SpectralKernels& spectral_kernels(InstructionSet set) {
  static constexpr SpectralKernels two = SpectralKernelsOf<2>::table("two lanes");
#if defined(__x86_64__)
  if (set == InstructionSet::widest && has_good_avx512()) return avx512_spectral_kernels();
  if (set != InstructionSet::baseline && has_avx2()) return avx2_spectral_kernels();
#endif
  return two;
}

}  // namespace backlight
