// The operations that need no function of the C library. Compiled with -frounding-math and run while rounding
// upwards.
#include "bounds.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "backlight/expression/operations.h"

namespace backlight {

namespace {

/// |x|ⁿ rounded up, and minus |x|ⁿ rounded down. The same products as those of the function for doubles, so
/// that its value lies between the two.
double power_up(double magnitude, unsigned n) {
  return integer_power(magnitude, n);
}
double minus_power_down(double magnitude, unsigned n) {
  // -(a·b) rounded up is minus a·b rounded down.
  double minus = -magnitude;
  for (int bit = static_cast<int>(std::bit_width(n)) - 2; bit >= 0; --bit) {
    minus = -minus * minus;
    if ((n >> bit & 1U) != 0) minus *= magnitude;
  }
  return minus;
}

}  // namespace

Bounds operator/(const Bounds& a, const Bounds& b) {
  Continuity continuity = worse(a, b);
  if (continuity == Continuity::undefined || is_zero(b)) return nowhere();
  if (may_overflow(a) && may_overflow(b)) {
    // As with a difference of infinities.
    if (overflows(a) && overflows(b)) return nowhere();
    continuity = std::max(continuity, Continuity::partial);
  }
  if (b.minus_lower > 0.0 && b.upper > 0.0) return everything(Continuity::partial);
  const bool negative = b.upper <= 0.0;
  const Bounds above = negative ? -a : a;
  const double nearest = negative ? -b.upper : -b.minus_lower;  // of |b|
  const double farthest = negative ? b.minus_lower : b.upper;
  if (nearest == 0.0) {
    const Bounds inverse{-1.0 / farthest, infinity, Continuity::partial};
    return product(above, inverse, Continuity::partial);
  }
  const double upper = above.upper / (above.upper >= 0.0 ? nearest : farthest);
  const double minus_lower = above.minus_lower / (above.minus_lower >= 0.0 ? nearest : farthest);
  return {minus_lower, upper, continuity};
}

Bounds integer_power(const Bounds& a, const Bounds& exponent) {
  if (a.is_undefined()) return a;
  const auto n = static_cast<unsigned>(exponent.upper);
  if (n % 2 == 0) {
    return {minus_power_down(least_magnitude(a), n), power_up(std::max(a.minus_lower, a.upper), n),
            a.continuity};
  }
  const double upper = a.upper >= 0.0 ? power_up(a.upper, n) : minus_power_down(-a.upper, n);
  const double minus_lower =
      a.minus_lower >= 0.0 ? power_up(a.minus_lower, n) : minus_power_down(-a.minus_lower, n);
  return {minus_lower, upper, a.continuity};
}

Bounds sqrt(const Bounds& a) {
  if (a.is_undefined() || a.upper < 0.0) return nowhere();
  const double low = -a.minus_lower;
  const double root = std::sqrt(std::max(low, 0.0));
  // root was rounded up, so low/root is not above √low
  return {low > 0.0 && low < infinity ? -low / root : 0.0, std::sqrt(a.upper),
          low < 0.0 ? Continuity::partial : a.continuity};
}

Bounds abs(const Bounds& a) {
  if (a.is_undefined()) return a;
  return {-least_magnitude(a), std::max(a.minus_lower, a.upper), a.continuity};
}

Bounds floor(const Bounds& a) {
  if (a.is_undefined()) return a;
  const double low = std::floor(-a.minus_lower);
  const double high = std::floor(a.upper);
  return {-low, high, low == high ? a.continuity : std::max(a.continuity, Continuity::defined)};
}

Bounds minimum(const Bounds& a, const Bounds& b) {
  const Continuity continuity = worse(a, b);
  if (continuity == Continuity::undefined) return nowhere();
  return {std::max(a.minus_lower, b.minus_lower), std::min(a.upper, b.upper), continuity};
}

Bounds maximum(const Bounds& a, const Bounds& b) {
  const Continuity continuity = worse(a, b);
  if (continuity == Continuity::undefined) return nowhere();
  return {std::min(a.minus_lower, b.minus_lower), std::max(a.upper, b.upper), continuity};
}

Bounds modulo(const Bounds& a, const Bounds& b) {
  const Bounds quotient = a / b;
  if (quotient.is_undefined()) return nowhere();
  const Bounds whole = floor(quotient);
  const Bounds difference = a - b * whole;
  if (whole.continuity == Continuity::continuous) return difference;
  // Over several periods the difference is loose. The remainder itself lies between 0 and b; computed in
  // doubles, it may leave that by the rounding of a.
  const double slack = 4e-16 * std::max(a.minus_lower, a.upper);
  const Bounds remainder{std::max(b.minus_lower, 0.0) + slack, std::max(b.upper, 0.0) + slack,
                         whole.continuity};
  return checked(std::min(difference.minus_lower, remainder.minus_lower),
                 std::min(difference.upper, remainder.upper), whole.continuity);
}

Bounds sign(const Bounds& a) {
  if (a.is_undefined()) return a;
  return {a.minus_lower > 0.0   ? 1.0
          : a.minus_lower < 0.0 ? -1.0
                                : 0.0,
          a.upper > 0.0   ? 1.0
          : a.upper < 0.0 ? -1.0
                          : 0.0,
          Continuity::continuous};
}

Bounds slope_of_minimum(const Bounds& a, const Bounds& b) {
  if (a.is_undefined() || b.is_undefined()) return nowhere();
  const bool always = a.upper < -b.minus_lower;
  const bool never = b.upper < -a.minus_lower;
  return {always ? -1.0 : 0.0, never ? 0.0 : 1.0, Continuity::continuous};
}

Bounds slope_of_maximum(const Bounds& a, const Bounds& b) {
  return slope_of_minimum(b, a);
}

}  // namespace backlight
