// The kernels for AVX2: four lanes. As src/trace/sheet_kernels_avx2.cpp.
#include "spectral_kernel_templates.h"

namespace backlight {

const SpectralKernels& avx2_spectral_kernels();

const SpectralKernels& avx2_spectral_kernels() {
  static constexpr SpectralKernels four = SpectralKernelsOf<4>::table("AVX2, four lanes");
  return four;
}

}  // namespace backlight
