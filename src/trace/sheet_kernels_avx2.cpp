// The kernels for AVX2: four lanes. Compiled with -mavx2 (and so without fused products, which would change
// bits), whatever the rest of the program is compiled for; nothing here may be called before the machine was
// asked.
#include "sheet_kernels.h"

namespace backlight {

const SheetKernels& avx2_sheet_kernels();

const SheetKernels& avx2_sheet_kernels() {
  static constexpr SheetKernels four = KernelsOf<4>::table("AVX2, four lanes");
  return four;
}

}  // namespace backlight
