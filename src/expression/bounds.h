// Interval arithmetic for a processor that rounds upwards: include only in files compiled with
// -frounding-math, and use only while a RoundUp lives.
//
// The lower end is kept with its sign changed, so that rounding upwards is outward for both ends.
#pragma once

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

}  // namespace backlight
