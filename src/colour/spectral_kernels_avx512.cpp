// The kernels for AVX-512: eight lanes. As src/trace/sheet_kernels_avx2.cpp.
#include "spectral_kernel_templates.h"

namespace backlight {

const SpectralKernels& avx512_spectral_kernels();

const SpectralKernels& avx512_spectral_kernels() {
  static constexpr SpectralKernels eight = SpectralKernelsOf<8>::table("AVX-512, eight lanes");
  return eight;
}

}  // namespace backlight
