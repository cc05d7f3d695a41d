// Which instructions this processor has, for what comes in several widths of lanes (base/lanes.h).
#pragma once

namespace backlight {

/// Which instructions kernels over lanes use. All give the same bits.
enum class InstructionSet {
  widest,   ///< the most lanes that this machine has
  avx2,     ///< four lanes, where it has them
  baseline  ///< those that every machine of its kind has
};

/// Four lanes.
inline bool has_avx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

/// Eight lanes. Processors that had AVX-512 before they had VBMI2 slow down when they use it.
inline bool has_good_avx512() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
         __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512vbmi2") != 0;
#else
  return false;
#endif
}

}  // namespace backlight
