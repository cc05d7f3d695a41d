// The kernels for AVX-512: eight lanes. As sheet_kernels_avx2.cpp.
#include "sheet_kernels.h"

namespace backlight {

const SheetKernels& avx512_sheet_kernels();

const SheetKernels& avx512_sheet_kernels() {
  static constexpr SheetKernels eight = KernelsOf<8>::table("AVX-512, eight lanes");
  return eight;
}

}  // namespace backlight
