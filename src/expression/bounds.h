// Interval arithmetic for a processor that rounds upwards: include only in files compiled with
// -frounding-math, and use only while a RoundUp lives.
//
// The lower end is kept with its sign changed, so that rounding upwards is outward for both ends.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "backlight/expression/interval.h"

namespace backlight {

struct Bounds {
  double minus_lower = 0.0;
  double upper = 0.0;
  Continuity continuity = Continuity::continuous;

  Bounds() = default;
  /// The interval of one number; infinity stands for all numbers that no double reaches.
  explicit Bounds(double number);
  Bounds(double minus_low, double high, Continuity c) : minus_lower(minus_low), upper(high), continuity(c) {}
  explicit Bounds(const Interval& i) : minus_lower(-i.lower), upper(i.upper), continuity(i.continuity) {}

  [[nodiscard]] double lower() const { return -minus_lower; }
  [[nodiscard]] bool is_undefined() const { return continuity == Continuity::undefined; }
  [[nodiscard]] Interval interval() const { return {-minus_lower, upper, continuity}; }
  bool operator!=(const Bounds& b) const { return minus_lower != b.minus_lower || upper != b.upper; }
};

Bounds operator+(const Bounds& a, const Bounds& b);
Bounds operator-(const Bounds& a, const Bounds& b);
Bounds operator*(const Bounds& a, const Bounds& b);
Bounds operator/(const Bounds& a, const Bounds& b);
Bounds operator-(const Bounds& a);
Bounds square(const Bounds& a);
Bounds integer_power(const Bounds& a, const Bounds& n);
Bounds sin(const Bounds& a);
Bounds cos(const Bounds& a);
Bounds tan(const Bounds& a);
Bounds asin(const Bounds& a);
Bounds acos(const Bounds& a);
Bounds atan(const Bounds& a);
Bounds atan2(const Bounds& y, const Bounds& x);
Bounds sinh(const Bounds& a);
Bounds cosh(const Bounds& a);
Bounds tanh(const Bounds& a);
Bounds exp(const Bounds& a);
Bounds log(const Bounds& a);
Bounds sqrt(const Bounds& a);
Bounds cbrt(const Bounds& a);
Bounds abs(const Bounds& a);
Bounds floor(const Bounds& a);
Bounds minimum(const Bounds& a, const Bounds& b);
Bounds maximum(const Bounds& a, const Bounds& b);
Bounds pow(const Bounds& a, const Bounds& b);
Bounds modulo(const Bounds& a, const Bounds& b);
// Slopes at kinks are those on both sides.
Bounds sign(const Bounds& a);
Bounds slope_of_minimum(const Bounds& a, const Bounds& b);
Bounds slope_of_maximum(const Bounds& a, const Bounds& b);
Bounds slope_of_exponent(const Bounds& a, const Bounds& v);

// The operations of most formulas, here to be inlined.

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double largest = std::numeric_limits<double>::max();

inline Bounds nowhere() {
  return {-infinity, -infinity, Continuity::undefined};
}
inline Bounds everything(Continuity continuity) {
  return {infinity, infinity, continuity};
}
/// Ends that were found apart from each other, as by lanes, which do not say where nothing is defined: no
/// interval if they are the wrong way round, or not numbers.
inline Bounds checked(double minus_lower, double upper, Continuity continuity) {
  return -minus_lower <= upper ? Bounds(minus_lower, upper, continuity) : nowhere();
}
inline Continuity worse(const Bounds& a, const Bounds& b) {
  return std::max(a.continuity, b.continuity);
}
/// The smallest |x| in the interval.
inline double least_magnitude(const Bounds& a) {
  return std::max(0.0, std::max(-a.minus_lower, -a.upper));
}

inline Bounds::Bounds(double number) : minus_lower(-number), upper(number) {
  if (std::isnan(number)) {
    *this = nowhere();
  } else if (std::isinf(number)) {
    number > 0.0 ? minus_lower = -largest : upper = -largest;
  }
}

/// In interval arithmetic an infinite end stands for arbitrarily large numbers, and 0 times those is 0.
inline double extended_product(double x, double y) {
  return x == 0.0 || y == 0.0 ? 0.0 : x * y;
}

/// The double of a number that is certainly beyond all doubles: an infinity.
inline bool overflows(const Bounds& a) {
  return a.minus_lower <= -largest || a.upper <= -largest;
}
inline bool may_overflow(const Bounds& a) {
  return a.minus_lower == infinity || a.upper == infinity;
}
inline bool is_zero(const Bounds& a) {
  return a.minus_lower == 0.0 && a.upper == 0.0;
}

inline Bounds product(const Bounds& a, const Bounds& b, Continuity continuity) {
  // Ends that are not -infinity add up to infinity when one of them is: else there is no 0 times infinity.
  if ((a.minus_lower + a.upper) + (b.minus_lower + b.upper) < infinity) {
    return {std::max(std::max(a.minus_lower * b.upper, a.upper * b.minus_lower),
                     std::max(-a.minus_lower * b.minus_lower, -a.upper * b.upper)),
            std::max(std::max(a.minus_lower * b.minus_lower, a.upper * b.upper),
                     std::max(-a.minus_lower * b.upper, a.upper * -b.minus_lower)),
            continuity};
  }
  const double upper = std::max(
      std::max(extended_product(a.minus_lower, b.minus_lower), extended_product(a.upper, b.upper)),
      std::max(extended_product(-a.minus_lower, b.upper), extended_product(a.upper, -b.minus_lower)));
  const double minus_lower = std::max(
      std::max(extended_product(a.minus_lower, b.upper), extended_product(a.upper, b.minus_lower)),
      std::max(extended_product(-a.minus_lower, b.minus_lower), extended_product(-a.upper, b.upper)));
  return {minus_lower, upper, continuity};
}

/// The law is what doubles say: where both terms are beyond them, and of different signs, there is no value.
[[gnu::noinline]] inline Bounds difference_of_infinities(const Bounds& a, const Bounds& b) {
  if (overflows(a) && overflows(b)) return nowhere();
  return everything(may_overflow(a) && may_overflow(b) ? std::max(worse(a, b), Continuity::partial)
                                                       : worse(a, b));
}

/// 0 times what is certainly beyond all doubles: in doubles that is no number.
inline bool nothing_of_infinity(const Bounds& a, const Bounds& b) {
  return (is_zero(a) && overflows(b)) || (is_zero(b) && overflows(a));
}

inline Bounds operator+(const Bounds& a, const Bounds& b) {
  const Continuity continuity = worse(a, b);
  if (continuity == Continuity::undefined) return nowhere();
  const Bounds sum{a.minus_lower + b.minus_lower, a.upper + b.upper, continuity};
  return sum.minus_lower == infinity && sum.upper == infinity ? difference_of_infinities(a, b) : sum;
}

inline Bounds operator-(const Bounds& a) {
  return {a.upper, a.minus_lower, a.continuity};
}

inline Bounds operator-(const Bounds& a, const Bounds& b) {
  return a + -b;
}

inline Bounds operator*(const Bounds& a, const Bounds& b) {
  const Continuity continuity = worse(a, b);
  if (continuity == Continuity::undefined || nothing_of_infinity(a, b)) return nowhere();
  return product(a, b, continuity);
}

inline Bounds square(const Bounds& a) {
  if (a.is_undefined()) return a;
  const double most = std::max(a.minus_lower, a.upper);
  const double least = least_magnitude(a);
  return {-least * least, most * most, a.continuity};
}

}  // namespace backlight
