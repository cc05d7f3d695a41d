// The kernels for the instructions that every machine of its kind has (SSE2, NEON): two lanes.
#include "backlight/base/instruction_sets.h"
#include "sheet_kernels.h"

namespace backlight {

#if defined(__x86_64__)
const SheetKernels& avx2_sheet_kernels();
const SheetKernels& avx512_sheet_kernels();
#endif

const SheetKernels& sheet_kernels(InstructionSet set) {
  static constexpr SheetKernels two = KernelsOf<2>::table("two lanes");
#if defined(__x86_64__)
  if (set == InstructionSet::widest && has_good_avx512()) return avx512_sheet_kernels();
  if (set != InstructionSet::baseline && has_avx2()) return avx2_sheet_kernels();
#endif
  return two;
}

}  // namespace backlight
