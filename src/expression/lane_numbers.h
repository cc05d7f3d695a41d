// The number types of the kernels for lines: outward-rounded bounds and plain numbers, over lanes. Both have
// every function of the table of operations.
//
// Bounds are meant for rounding upwards (rounding.h), the lower end with its sign changed. They do without
// the special cases of Bounds: wherever one would be needed (infinite ends, a division by what may be zero, a
// domain that is left, a jump) the processor's exception flags tell, and the caller computes that line again
// with Bounds.
#pragma once

#include "backlight/base/lane_waves.h"
#include "backlight/base/lanes.h"
#include "line_work.h"

namespace backlight {

template <class V>
struct LaneBounds {
  V minus_lower, upper;

  LaneBounds() = default;
  explicit BACKLIGHT_LANES LaneBounds(double number) : minus_lower(-number), upper(number) {}
  BACKLIGHT_LANES LaneBounds(V minus_low, V high) : minus_lower(minus_low), upper(high) {}

  friend BACKLIGHT_LANES LaneBounds operator+(LaneBounds a, LaneBounds b) {
    return {a.minus_lower + b.minus_lower, a.upper + b.upper};
  }
  friend BACKLIGHT_LANES LaneBounds operator-(LaneBounds a) { return {a.upper, a.minus_lower}; }
  friend BACKLIGHT_LANES LaneBounds operator-(LaneBounds a, LaneBounds b) {
    return {a.minus_lower + b.upper, a.upper + b.minus_lower};
  }
  friend BACKLIGHT_LANES LaneBounds operator*(LaneBounds a, LaneBounds b) {
    const V a_lower = -a.minus_lower;
    const V b_lower = -b.minus_lower;
    return {larger(larger(a.minus_lower * b.upper, a.upper * b.minus_lower),
                   larger(a_lower * b.minus_lower, (-a.upper) * b.upper)),
            larger(larger(a.minus_lower * b.minus_lower, a.upper * b.upper),
                   larger(a_lower * b.upper, a.upper * b_lower))};
  }
  friend BACKLIGHT_LANES LaneBounds operator/(LaneBounds a, LaneBounds b) {
    const auto positive = b.minus_lower < V(0.0);
    const auto negative = b.upper < V(0.0);
    if (bits(~(positive | negative)) != 0) note_trouble();
    // For b < 0 both signs are changed.
    const V a_minus_lower = select(negative, a.upper, a.minus_lower);
    const V a_upper = select(negative, a.minus_lower, a.upper);
    const V nearest = select(negative, -b.upper, -b.minus_lower);
    const V farthest = select(negative, b.minus_lower, b.upper);
    return {a_minus_lower / select(a_minus_lower >= V(0.0), nearest, farthest),
            a_upper / select(a_upper >= V(0.0), nearest, farthest)};
  }
};

/// The smallest |x| in the interval.
template <class V>
BACKLIGHT_LANES V least_magnitude(LaneBounds<V> a) {
  return larger(V(0.0), larger(-a.minus_lower, -a.upper));
}

template <class V>
BACKLIGHT_LANES LaneBounds<V> square(LaneBounds<V> a) {
  const V most = larger(a.minus_lower, a.upper);
  const V least = least_magnitude(a);
  return {(-least) * least, most * most};
}

/// Powers of magnitudes, from the lowest bit of the exponent up: |x|ⁿ rounded up, and minus |x|ⁿ rounded
/// down.
template <class V>
BACKLIGHT_LANES V power_up(V size, unsigned n) {
  V result(1.0);
  for (V square = size;; square = square * square) {
    if ((n & 1U) != 0) result = result * square;
    n >>= 1U;
    if (n == 0) return result;
  }
}
template <class V>
BACKLIGHT_LANES V minus_power_down(V size, unsigned n) {
  V result(-1.0);
  for (V minus_square = -size;; minus_square = (-minus_square) * minus_square) {
    if ((n & 1U) != 0) result = result * -minus_square;
    n >>= 1U;
    if (n == 0) return result;
  }
}

template <class V>
BACKLIGHT_LANES LaneBounds<V> integer_power(LaneBounds<V> a, LaneBounds<V> exponent) {
  const auto n = static_cast<unsigned>(exponent.upper.v[0]);  // a constant: the same in all lanes
  if (n == 0) return LaneBounds<V>(1.0);
  if (n % 2 == 0) {
    return {minus_power_down(least_magnitude(a), n), power_up(larger(a.minus_lower, a.upper), n)};
  }
  const V most_up = power_up(magnitude(a.upper), n);
  const V most_down = minus_power_down(magnitude(a.upper), n);
  const V least_up = power_up(magnitude(a.minus_lower), n);
  const V least_down = minus_power_down(magnitude(a.minus_lower), n);
  return {select(a.minus_lower >= V(0.0), least_up, least_down),
          select(a.upper >= V(0.0), most_up, most_down)};
}

template <class V>
BACKLIGHT_LANES LaneBounds<V> abs(LaneBounds<V> a) {
  return {-least_magnitude(a), larger(a.minus_lower, a.upper)};
}

template <class V>
BACKLIGHT_LANES LaneBounds<V> minimum(LaneBounds<V> a, LaneBounds<V> b) {
  return {larger(a.minus_lower, b.minus_lower), -larger(-a.upper, -b.upper)};
}
template <class V>
BACKLIGHT_LANES LaneBounds<V> maximum(LaneBounds<V> a, LaneBounds<V> b) {
  return {-larger(-a.minus_lower, -b.minus_lower), larger(a.upper, b.upper)};
}

template <class V>
BACKLIGHT_LANES LaneBounds<V> sqrt(LaneBounds<V> a) {
  if (bits(a.minus_lower > V(0.0)) != 0) note_trouble();
  const V root = sqrt(-a.minus_lower);  // rounded up, so that low/root is not above the root of low
  const V low = select(a.minus_lower < V(0.0), a.minus_lower / select(root > V(0.0), root, V(1.0)), V(0.0));
  return {low, sqrt(a.upper)};
}

/// Of a slope's |a|: the slopes on both sides of a kink.
template <class V>
BACKLIGHT_LANES LaneBounds<V> sign(LaneBounds<V> a) {
  const V zero(0.0);
  const auto of = [&](V end) { return select(end > zero, V(1.0), select(end < zero, V(-1.0), zero)); };
  return {of(a.minus_lower), of(a.upper)};
}
template <class V>
BACKLIGHT_LANES LaneBounds<V> slope_of_minimum(LaneBounds<V> a, LaneBounds<V> b) {
  return {select(a.upper < -b.minus_lower, V(-1.0), V(0.0)),
          select(b.upper < -a.minus_lower, V(0.0), V(1.0))};
}
template <class V>
BACKLIGHT_LANES LaneBounds<V> slope_of_maximum(LaneBounds<V> a, LaneBounds<V> b) {
  return slope_of_minimum(b, a);
}

template <class V>
BACKLIGHT_LANES LaneBounds<V> library(Operation operation, LaneBounds<V> a, LaneBounds<V> b) {
  double of[6][V::width];
  a.minus_lower.store(of[0]);
  a.upper.store(of[1]);
  b.minus_lower.store(of[2]);
  b.upper.store(of[3]);
  bounds_of_each(operation, V::width, of[0], of[1], of[2], of[3], of[4], of[5]);
  return {V::load(of[4]), V::load(of[5])};
}

/// Whether some phase + 4k, k whole, can lie between two numbers of quarter turns. Errs towards yes.
template <class V>
BACKLIGHT_LANES auto may_hold(V low, V high, double phase) {
  const V room(1e-15);
  const V first = (low - V(phase)) * V(0.25) - room * (V(1.0) + magnitude(low));
  const V last = (high - V(phase)) * V(0.25) + room * (V(1.0) + magnitude(high));
  return floor_of(last) >= first;  // the largest whole number not above `last` is not below `first`
}

template <class V>
struct BoundsOfWaves {
  LaneBounds<V> sine, cosine;
};

/// A function with a kernel for arguments that are near enough, and by the library for those that are not:
/// lane by lane, so that no lane depends on the others. `near` says which lanes are which.
template <class N, class Mask, class Kernel>
BACKLIGHT_LANES N wave(Operation operation, N a, Mask near, const Kernel& kernel) {
  if (bits(~near) == 0) return kernel(a);
  return select(near, kernel(select(near, a, N(0.0))), library(operation, a, a));
}

template <class V>
BACKLIGHT_LANES LaneBounds<V> select(typename V::Mask mask, LaneBounds<V> a, LaneBounds<V> b) {
  return {select(mask, a.minus_lower, b.minus_lower), select(mask, a.upper, b.upper)};
}
template <class V>
BACKLIGHT_LANES auto near_enough_for_waves(LaneBounds<V> a) {
  return larger(magnitude(a.minus_lower), magnitude(a.upper)) <= V(largest_wave_argument);
}

template <class V>
BACKLIGHT_LANES BoundsOfWaves<V> bounds_of_waves(LaneBounds<V> a) {
  const V low = -a.minus_lower;
  const Waves<V> first = waves(low);
  const Waves<V> last = waves(a.upper);
  const V two_over_pi(0.63661977236758134308);
  const V from = low * two_over_pi;
  const V to = a.upper * two_over_pi;
  const V error(wave_error);
  const V one(1.0);
  const auto enclosed = [&](V at_first, V at_last, double crest, double trough) {
    const V up = -larger(-one, -(larger(at_first, at_last) + error));
    const V minus_low = -larger(-one, -(larger(-at_first, -at_last) + error));
    return LaneBounds<V>(select(may_hold(from, to, trough), one, minus_low),
                         select(may_hold(from, to, crest), one, up));
  };
  return {enclosed(first.sine, last.sine, 1.0, 3.0), enclosed(first.cosine, last.cosine, 0.0, 2.0)};
}

template <class V>
BACKLIGHT_LANES LaneBounds<V> sin(LaneBounds<V> a) {
  return wave(
      Operation::sin, a, near_enough_for_waves(a),
      [](LaneBounds<V> near) __attribute__((always_inline)) { return bounds_of_waves(near).sine; });
}
template <class V>
BACKLIGHT_LANES LaneBounds<V> cos(LaneBounds<V> a) {
  return wave(
      Operation::cos, a, near_enough_for_waves(a),
      [](LaneBounds<V> near) __attribute__((always_inline)) { return bounds_of_waves(near).cosine; });
}

/// Plain numbers over lanes.
template <class V>
struct LaneNumber {
  V v;

  LaneNumber() = default;
  explicit BACKLIGHT_LANES LaneNumber(double number) : v(number) {}
  explicit BACKLIGHT_LANES LaneNumber(V lanes) : v(lanes) {}

  friend BACKLIGHT_LANES LaneNumber operator+(LaneNumber a, LaneNumber b) { return LaneNumber(a.v + b.v); }
  friend BACKLIGHT_LANES LaneNumber operator-(LaneNumber a, LaneNumber b) { return LaneNumber(a.v - b.v); }
  friend BACKLIGHT_LANES LaneNumber operator*(LaneNumber a, LaneNumber b) { return LaneNumber(a.v * b.v); }
  friend BACKLIGHT_LANES LaneNumber operator/(LaneNumber a, LaneNumber b) { return LaneNumber(a.v / b.v); }
  friend BACKLIGHT_LANES LaneNumber operator-(LaneNumber a) { return LaneNumber(-a.v); }
};

template <class V>
BACKLIGHT_LANES LaneNumber<V> square(LaneNumber<V> a) {
  return a * a;
}
template <class V>
BACKLIGHT_LANES LaneNumber<V> integer_power(LaneNumber<V> a, LaneNumber<V> exponent) {
  const auto n = static_cast<unsigned>(exponent.v.v[0]);
  LaneNumber<V> result(1.0);
  LaneNumber<V> square = a;
  for (unsigned rest = n; rest != 0; rest >>= 1U, square = square * square) {
    if ((rest & 1U) != 0) result = result * square;
  }
  return result;
}
template <class V>
BACKLIGHT_LANES LaneNumber<V> sqrt(LaneNumber<V> a) {
  return LaneNumber<V>(sqrt(a.v));
}
template <class V>
BACKLIGHT_LANES LaneNumber<V> abs(LaneNumber<V> a) {
  return LaneNumber<V>(magnitude(a.v));
}
template <class V>
BACKLIGHT_LANES LaneNumber<V> minimum(LaneNumber<V> a, LaneNumber<V> b) {
  return LaneNumber<V>(select(a.v < b.v, a.v, b.v));
}
template <class V>
BACKLIGHT_LANES LaneNumber<V> maximum(LaneNumber<V> a, LaneNumber<V> b) {
  return LaneNumber<V>(select(a.v > b.v, a.v, b.v));
}
template <class V>
BACKLIGHT_LANES LaneNumber<V> sign(LaneNumber<V> a) {
  return LaneNumber<V>(select(a.v > V(0.0), V(1.0), select(a.v < V(0.0), V(-1.0), V(0.0))));
}
template <class V>
BACKLIGHT_LANES LaneNumber<V> slope_of_minimum(LaneNumber<V> a, LaneNumber<V> b) {
  return LaneNumber<V>(select(a.v < b.v, V(1.0), V(0.0)));
}
template <class V>
BACKLIGHT_LANES LaneNumber<V> slope_of_maximum(LaneNumber<V> a, LaneNumber<V> b) {
  return LaneNumber<V>(select(a.v > b.v, V(1.0), V(0.0)));
}

template <class V>
BACKLIGHT_LANES LaneNumber<V> library(Operation operation, LaneNumber<V> a, LaneNumber<V> b) {
  double of[3][V::width];
  a.v.store(of[0]);
  b.v.store(of[1]);
  number_of_each(operation, V::width, of[0], of[1], of[2]);
  return LaneNumber<V>(V::load(of[2]));
}

template <class V>
BACKLIGHT_LANES LaneNumber<V> select(typename V::Mask mask, LaneNumber<V> a, LaneNumber<V> b) {
  return LaneNumber<V>(select(mask, a.v, b.v));
}
template <class V>
BACKLIGHT_LANES auto near_enough_for_waves(LaneNumber<V> a) {
  return magnitude(a.v) <= V(largest_wave_argument);
}
template <class V>
BACKLIGHT_LANES LaneNumber<V> sin(LaneNumber<V> a) {
  return wave(
      Operation::sin, a, near_enough_for_waves(a),
      [](LaneNumber<V> near) __attribute__((always_inline)) { return LaneNumber<V>(waves(near.v).sine); });
}
template <class V>
BACKLIGHT_LANES LaneNumber<V> cos(LaneNumber<V> a) {
  return wave(
      Operation::cos, a, near_enough_for_waves(a),
      [](LaneNumber<V> near) __attribute__((always_inline)) { return LaneNumber<V>(waves(near.v).cosine); });
}

// The functions that the library computes, one lane at a time, for every number type over lanes: name(a), and
// name(a, b) with the operation that it is.
#define BACKLIGHT_LIBRARY_FUNCTIONS(X) \
  X(tan) X(asin) X(acos) X(atan) X(sinh) X(cosh) X(tanh) X(exp) X(log) X(cbrt) X(floor)
#define BACKLIGHT_LIBRARY_FUNCTIONS_OF_TWO(X) X(atan2, atan2) X(pow, pow) X(modulo, mod)

#define BACKLIGHT_ONE_BY_ONE(name)                      \
  template <class V>                                    \
  BACKLIGHT_LANES LaneBounds<V> name(LaneBounds<V> a) { \
    return library(Operation::name, a, a);              \
  }                                                     \
  template <class V>                                    \
  BACKLIGHT_LANES LaneNumber<V> name(LaneNumber<V> a) { \
    return library(Operation::name, a, a);              \
  }
BACKLIGHT_LIBRARY_FUNCTIONS(BACKLIGHT_ONE_BY_ONE)
#undef BACKLIGHT_ONE_BY_ONE

#define BACKLIGHT_TWO_BY_TWO(name, operation)                            \
  template <class V>                                                     \
  BACKLIGHT_LANES LaneBounds<V> name(LaneBounds<V> a, LaneBounds<V> b) { \
    return library(Operation::operation, a, b);                          \
  }                                                                      \
  template <class V>                                                     \
  BACKLIGHT_LANES LaneNumber<V> name(LaneNumber<V> a, LaneNumber<V> b) { \
    return library(Operation::operation, a, b);                          \
  }
BACKLIGHT_LIBRARY_FUNCTIONS_OF_TWO(BACKLIGHT_TWO_BY_TWO)
#undef BACKLIGHT_TWO_BY_TWO

/// The slope of v = aᵇ along b.
template <class N>
BACKLIGHT_LANES N slope_of_exponent(N a, N v) {
  return v * log(a);
}

}  // namespace backlight
