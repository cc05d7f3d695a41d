// The operations made of functions of the C library. Compiled with -frounding-math and run while rounding
// upwards; the library's functions are called in the mode they are made for, to nearest, and their results
// are widened by more than their errors.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bounds.h"
#include "rounding.h"

namespace backlight {
namespace {

using std::numbers::pi;

/// More than the largest error of any of glibc's functions used here, in units of 2⁻⁵² of the result (its
/// manual lists at most 4, for cbrt), and likewise below the normal numbers.
constexpr double library_error = 6.0;
constexpr double relative_error = library_error * std::numeric_limits<double>::epsilon();
constexpr double absolute_error = library_error * std::numeric_limits<double>::denorm_min();

using Function = double (*)(double);

/// Not less than the exact value where the library says `value`. Below -infinity there are numbers still.
double widened(double value) {
  if (value == -infinity) return -largest;
  return value + (std::abs(value) * relative_error + absolute_error);
}
double above(Function f, double x) {
  return widened(at_nearest(f, x));
}
double minus_below(Function f, double x) {
  return widened(-at_nearest(f, x));
}

Bounds increasing(Function f, const Bounds& a) {
  if (a.is_undefined()) return a;
  return {minus_below(f, -a.minus_lower), above(f, a.upper), a.continuity};
}

/// No function value lies outside [low, high].
Bounds clipped(const Bounds& a, double low, double high) {
  return {std::min(a.minus_lower, -low), std::min(a.upper, high), a.continuity};
}

/// Whether phase + 2πk (or πk, for half turns), k whole, can lie in the interval. Errs towards yes.
bool may_hold_phase(const Bounds& a, double phase, double period) {
  const double low = (-a.minus_lower - phase) / period;
  const double high = (a.upper - phase) / period;
  constexpr double error = 8.0 * std::numeric_limits<double>::epsilon();
  const double below = low - error * (1.0 + std::abs(low));
  const double beyond = high + error * (1.0 + std::abs(high));
  return std::floor(beyond) >= std::ceil(below);
}

/// sin or cos, whose maxima lie at `crest` + 2πk.
Bounds wave(Function f, const Bounds& a, double crest) {
  if (a.is_undefined() || overflows(a)) return nowhere();
  if (!(a.upper + a.minus_lower < 2.0 * pi)) return {1.0, 1.0, a.continuity};
  const double low = -a.minus_lower;
  double upper = std::max(above(f, low), above(f, a.upper));
  double minus_lower = std::max(minus_below(f, low), minus_below(f, a.upper));
  if (may_hold_phase(a, crest, 2.0 * pi)) upper = 1.0;
  if (may_hold_phase(a, crest + pi, 2.0 * pi)) minus_lower = 1.0;
  return clipped({minus_lower, upper, a.continuity}, -1.0, 1.0);
}

/// The part of the interval inside [low, high], and whether it is only a part. Nothing: undefined.
Bounds restricted(const Bounds& a, double low, double high) {
  if (a.is_undefined() || a.upper < low || -a.minus_lower > high) return nowhere();
  const bool inside = -a.minus_lower >= low && a.upper <= high;
  return {std::min(a.minus_lower, -low), std::min(a.upper, high),
          inside ? a.continuity : Continuity::partial};
}

double library_pow(double x, double y) {
  return at_nearest<double, double>(std::pow, x, y);
}

/// aⁿ for a whole n of any size.
Bounds whole_power(const Bounds& a, double n) {
  if (n < 0.0) return Bounds(1.0) / whole_power(a, -n);
  const bool even = std::fmod(n, 2.0) == 0.0;
  if (even) {
    return clipped({widened(-library_pow(least_magnitude(a), n)),
                    widened(library_pow(std::max(a.minus_lower, a.upper), n)), a.continuity},
                   0.0, infinity);
  }
  return {widened(-library_pow(-a.minus_lower, n)), widened(library_pow(a.upper, n)), a.continuity};
}

/// aᵇ where a may be negative, which has powers for whole exponents only: as large as those of |a|.
Bounds power_of_any_sign(const Bounds& a, const Bounds& b) {
  double most = 0.0;
  for (const double x : {least_magnitude(a), std::max(a.minus_lower, a.upper)}) {
    for (const double y : {-b.minus_lower, b.upper}) most = std::max(most, widened(library_pow(x, y)));
  }
  return {most, most, Continuity::partial};
}

/// Continuous, but perhaps not where a base of zero makes it so.
Continuity continuity_of_power(const Bounds& base, const Bounds& exponent) {
  const bool at_zero = -base.minus_lower <= 0.0 && -exponent.minus_lower <= 0.0;
  return at_zero ? Continuity::partial : worse(base, exponent);
}

}  // namespace

Bounds sin(const Bounds& a) {
  return wave(std::sin, a, 0.5 * pi);
}

Bounds cos(const Bounds& a) {
  return wave(std::cos, a, 0.0);
}

Bounds tan(const Bounds& a) {
  if (a.is_undefined() || overflows(a)) return nowhere();
  if (!(a.upper + a.minus_lower < pi) || may_hold_phase(a, 0.5 * pi, pi)) {
    return everything(Continuity::partial);
  }
  return increasing(std::tan, a);
}

Bounds asin(const Bounds& a) {
  return increasing(std::asin, restricted(a, -1.0, 1.0));
}

Bounds acos(const Bounds& a) {
  const Bounds inside = restricted(a, -1.0, 1.0);
  if (inside.is_undefined()) return inside;
  return clipped(
      {minus_below(std::acos, inside.upper), above(std::acos, -inside.minus_lower), inside.continuity}, 0.0,
      infinity);
}

Bounds atan(const Bounds& a) {
  return increasing(std::atan, a);
}

Bounds atan2(const Bounds& y, const Bounds& x) {
  const Continuity continuity = worse(y, x);
  if (continuity == Continuity::undefined) return nowhere();
  const bool touches_axis = y.minus_lower >= 0.0 && y.upper >= 0.0;
  const bool holds_origin = touches_axis && x.minus_lower >= 0.0 && x.upper >= 0.0;
  // From which side of the cut a zero comes is told by its sign, which intervals do not keep.
  const bool crosses_cut = touches_axis && x.minus_lower > 0.0;
  if (holds_origin || crosses_cut) {
    const double half_turn = widened(pi);
    return {half_turn, half_turn,
            std::max(continuity, holds_origin ? Continuity::partial : Continuity::defined)};
  }
  // Elsewhere the angle is monotone along each side of the box.
  Bounds result{-infinity, -infinity, continuity};
  for (const double ordinate : {-y.minus_lower, y.upper}) {
    for (const double abscissa : {-x.minus_lower, x.upper}) {
      const double angle = at_nearest<double, double>(std::atan2, ordinate, abscissa);
      result.minus_lower = std::max(result.minus_lower, widened(-angle));
      result.upper = std::max(result.upper, widened(angle));
    }
  }
  return result;
}

Bounds sinh(const Bounds& a) {
  return increasing(std::sinh, a);
}

Bounds cosh(const Bounds& a) {
  if (a.is_undefined()) return a;
  return clipped({minus_below(std::cosh, least_magnitude(a)),
                  above(std::cosh, std::max(a.minus_lower, a.upper)), a.continuity},
                 1.0, infinity);
}

Bounds tanh(const Bounds& a) {
  return clipped(increasing(std::tanh, a), -1.0, 1.0);
}

Bounds exp(const Bounds& a) {
  return clipped(increasing(std::exp, a), 0.0, infinity);
}

Bounds log(const Bounds& a) {
  if (a.is_undefined() || a.upper <= 0.0) return nowhere();
  if (-a.minus_lower > 0.0) return increasing(std::log, a);
  return {infinity, above(std::log, a.upper), Continuity::partial};
}

Bounds cbrt(const Bounds& a) {
  return increasing(std::cbrt, a);
}

Bounds pow(const Bounds& a, const Bounds& b) {
  if (worse(a, b) == Continuity::undefined) return nowhere();
  if (-b.minus_lower == b.upper && std::floor(b.upper) == b.upper) {
    if (b.upper == 0.0) return {-1.0, 1.0, worse(a, b)};
    const Bounds result = whole_power(a, b.upper);
    return {result.minus_lower, result.upper, std::max(result.continuity, b.continuity)};
  }
  if (a.minus_lower > 0.0 && std::floor(b.upper) >= -b.minus_lower) {
    return power_of_any_sign(a, b);  // with a whole number among the exponents
  }
  const Bounds base = restricted(a, 0.0, infinity);
  if (base.is_undefined()) return base;
  Bounds result{-infinity, -infinity, continuity_of_power(base, b)};
  // Monotone in the base and in the exponent, so its extremes are at corners.
  for (const double x : {-base.minus_lower, base.upper}) {
    for (const double y : {-b.minus_lower, b.upper}) {
      const double value = library_pow(x + 0.0, y);  // no -0, whose powers may be -infinity
      result.minus_lower = std::max(result.minus_lower, widened(-value));
      result.upper = std::max(result.upper, widened(value));
    }
  }
  return clipped(result, 0.0, infinity);
}

/// v ln a for v = aᵇ, which goes to 0 or to -infinity with a.
Bounds slope_of_exponent(const Bounds& a, const Bounds& v) {
  if (a.upper == 0.0 && a.minus_lower == 0.0) return Bounds(0.0);
  return v * log(a);
}

}  // namespace backlight
