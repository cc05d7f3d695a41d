// The kernels for the instructions that every machine of its kind has (SSE2, NEON): two lanes.
#include "sheet_kernels.h"

namespace backlight {

#if defined(__x86_64__)
const SheetKernels& avx2_sheet_kernels();
#endif

const SheetKernels& sheet_kernels(InstructionSet set) {
  static constexpr SheetKernels two = KernelsOf<2>::table("two lanes");
#if defined(__x86_64__)
  if (set == InstructionSet::widest && __builtin_cpu_supports("avx2") != 0) return avx2_sheet_kernels();
#endif
  return two;
}

}  // namespace backlight
