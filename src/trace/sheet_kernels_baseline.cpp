// The kernels for the instructions that every machine of its kind has (SSE2, NEON): two lanes.
#include "sheet_kernels.h"

namespace backlight {

#if defined(__x86_64__)
const SheetKernels& avx2_sheet_kernels();
const SheetKernels& avx512_sheet_kernels();

namespace {

// Processors that had AVX-512 before they had VBMI2 slow down when they use it.
bool has_good_avx512() {
  return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
         __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512vbmi2") != 0;
}

}  // namespace
#endif

const SheetKernels& sheet_kernels(InstructionSet set) {
  static constexpr SheetKernels two = KernelsOf<2>::table("two lanes");
#if defined(__x86_64__)
  if (set == InstructionSet::widest && has_good_avx512()) return avx512_sheet_kernels();
  if (set != InstructionSet::baseline && __builtin_cpu_supports("avx2") != 0) return avx2_sheet_kernels();
#endif
  return two;
}

}  // namespace backlight
