// The kernels for every machine, and what they and the wider ones call.
#include <array>

#include "backlight/expression/interval.h"
#include "bounds.h"
#include "line_kernels.h"
#include "rounding.h"

namespace backlight {

void note_trouble() {
  raise_invalid();
}

void bounds_of_each(Operation operation, std::size_t lanes, const double* a_minus_lower,
                    const double* a_upper, const double* b_minus_lower, const double* b_upper,
                    double* minus_lower, double* upper) {
  for (std::size_t i = 0; i < lanes; ++i) {
    const Bounds a = checked(a_minus_lower[i], a_upper[i], Continuity::continuous);
    const Bounds b = checked(b_minus_lower[i], b_upper[i], Continuity::continuous);
    const Bounds result = apply<Bounds>(operation, a, b);
    // at_nearest() puts back the flags that tell of an overflow.
    const bool finite = result.minus_lower < infinity && result.upper < infinity;
    if (result.continuity != Continuity::continuous || !finite) note_trouble();
    minus_lower[i] = result.minus_lower;
    upper[i] = result.upper;
  }
}

void number_of_each(Operation operation, std::size_t lanes, const double* a, const double* b, double* value) {
  for (std::size_t i = 0; i < lanes; ++i) value[i] = apply<double>(operation, a[i], b[i]);
}

LineKernels baseline_line_kernels() {
#if defined(__SSE2__) || defined(__aarch64__)
  return line_kernels<2>();
#else
  return line_kernels<1>();
#endif
}

}  // namespace backlight
