// Reduced affine forms over lanes: centre + slope·ε ± error, |ε| <= 1. Meant for rounding upwards
// (rounding.h), where every sum and product of errors is outward by itself; what the rounding of centre and
// slope may be off is added to the error. One template for all widths, one lane (single_lane.h) included:
// that is the law of affine.cpp.
//
// Like LaneBounds, they do without special cases: where a form does not exist (a division by what may be
// zero, the root of what may be negative, a jump, an overflow) the processor's exception flags tell, and the
// caller computes that line by itself.
//
// Rounding upwards moves a number by less than 2⁻⁵² of the result, or by the smallest number of all, for
// which `tiny` is room. A sum of n rounded terms t is off by less than 2n·2⁻⁵²·Σ|t|.
#pragma once

#include "lane_numbers.h"

namespace backlight {

inline constexpr double rounding_unit = 0x1p-52;
inline constexpr double tiny = 0x1p-1000;

template <class V>
struct LaneAffine {
  V centre, slope, error;

  LaneAffine() = default;
  explicit BACKLIGHT_LANES LaneAffine(double number) : centre(number), slope(0.0), error(0.0) {}
  BACKLIGHT_LANES LaneAffine(V c, V s, V e) : centre(c), slope(s), error(e) {}

  friend BACKLIGHT_LANES LaneAffine operator-(LaneAffine a) { return {-a.centre, -a.slope, a.error}; }
  friend BACKLIGHT_LANES LaneAffine operator+(LaneAffine a, LaneAffine b) {
    const V c = a.centre + b.centre;
    const V s = a.slope + b.slope;
    return {c, s, (a.error + b.error) + V(rounding_unit) * (magnitude(c) + magnitude(s))};
  }
  friend BACKLIGHT_LANES LaneAffine operator-(LaneAffine a, LaneAffine b) { return a + -b; }

  // ε² = 1/2 ± 1/2. Four products and two sums are rounded: less than 2·2⁻⁵² of the sum of all products.
  friend BACKLIGHT_LANES LaneAffine operator*(LaneAffine a, LaneAffine b) {
    const V half = V(0.5) * (a.slope * b.slope);
    const V size_a = magnitude(a.centre) + magnitude(a.slope);
    const V size_b = magnitude(b.centre) + magnitude(b.slope);
    const V rounding = V(0x1.001p-51) * (size_a * size_b) + V(tiny);
    return {a.centre * b.centre + half, a.centre * b.slope + b.centre * a.slope,
            ((magnitude(half) + size_a * b.error) + a.error * (size_b + b.error)) + rounding};
  }

  friend BACKLIGHT_LANES LaneAffine operator/(LaneAffine a, LaneAffine b) { return a * inverse(b); }
};

// With a constant, for which these are the law: there is less to be rounded.
template <class V>
BACKLIGHT_LANES LaneAffine<V> plus_constant(LaneAffine<V> a, V number) {
  const V centre = a.centre + number;
  return {centre, a.slope, a.error + V(rounding_unit) * magnitude(centre)};
}
template <class V>
BACKLIGHT_LANES LaneAffine<V> times_constant(LaneAffine<V> a, V number) {
  const V centre = a.centre * number;
  const V slope = a.slope * number;
  return {
      centre, slope,
      (a.error * magnitude(number) + V(rounding_unit) * (magnitude(centre) + magnitude(slope))) + V(tiny)};
}

/// How far a form goes from its centre.
template <class V>
BACKLIGHT_LANES V radius(LaneAffine<V> a) {
  return magnitude(a.slope) + a.error;
}

/// [low, high] without a slope; `minus_low` is -low.
template <class V>
BACKLIGHT_LANES LaneAffine<V> without_slope(V minus_low, V high) {
  const V centre = V(0.5) * (high - minus_low);
  return {centre, V(0.0), larger(high - centre, centre + minus_low)};
}

template <class V>
BACKLIGHT_LANES LaneAffine<V> select(typename V::Mask mask, LaneAffine<V> a, LaneAffine<V> b) {
  return {select(mask, a.centre, b.centre), select(mask, a.slope, b.slope), select(mask, a.error, b.error)};
}

/// 1/b = (1 - δ + δ²/(1 + δ))/c about the centre c, where |δ| <= ρ = r/c; the last term is within
/// [0, ρ²/(1 - ρ)]. Where that is wider than all values of 1/b, those without a slope.
template <class V>
BACKLIGHT_LANES LaneAffine<V> inverse(LaneAffine<V> b) {
  const V size = magnitude(b.centre);
  const V reach = radius(b);
  const V minus_least = reach - size;
  if (bits(~(minus_least < V(0.0))) != 0) note_trouble();
  const V least = select(minus_least < V(0.0), -minus_least, V(1.0));
  const V bend = (reach * reach) / -((-size) * least);
  const V inverse = V(1.0) / select(size > V(0.0), b.centre, V(1.0));
  const V inverse_size = magnitude(inverse);
  const V half = V(0.5) * bend;
  const V rounding = V(0x1p-49) * (inverse_size * (V(1.0) + (reach * inverse_size + bend))) + V(tiny);
  const LaneAffine<V> form{inverse * (V(1.0) + half), -((inverse * inverse) * b.slope),
                           inverse_size * (b.error * inverse_size + half) + rounding};
  const LaneAffine<V> flat = without_slope(V(-1.0) / (size + reach), V(1.0) / least);
  const LaneAffine<V> turned = select(b.centre < V(0.0), -flat, flat);
  return select(form.error < flat.error, form, turned);
}

template <class V>
BACKLIGHT_LANES LaneAffine<V> square(LaneAffine<V> a) {
  const V half = V(0.5) * (a.slope * a.slope);
  const V size = magnitude(a.centre) + magnitude(a.slope);
  const V product = a.centre * a.slope;
  const V rounding = V(0x1.001p-51) * (size * size) + V(tiny);
  return {a.centre * a.centre + half, product + product,
          (half + ((size + size) + a.error) * a.error) + rounding};
}

template <class V>
BACKLIGHT_LANES LaneAffine<V> integer_power(LaneAffine<V> a, LaneAffine<V> exponent) {
  const auto n = static_cast<unsigned>(exponent.centre.v[0]);  // a constant: the same in all lanes
  if (n == 0) return {V(1.0), V(0.0), V(tiny)};
  LaneAffine<V> power = a;
  unsigned rest = n;
  for (; (rest & 1U) == 0; rest >>= 1U) power = square(power);
  LaneAffine<V> result = power;
  for (rest >>= 1U; rest != 0; rest >>= 1U) {
    power = square(power);
    if ((rest & 1U) != 0) result = result * power;
  }
  return result;
}

/// For every share p in [0, 1], min(a, b) is not above pa + (1-p)b, and below it by no more than the larger
/// of (1-p)(b-a) and p(a-b). The share is such that both are alike at the ends of a - b.
template <class V>
BACKLIGHT_LANES LaneAffine<V> minimum(LaneAffine<V> a, LaneAffine<V> b) {
  const LaneAffine<V> difference = a - b;
  const V reach = radius(difference);
  const V above = larger(V(0.0), difference.centre + reach);
  const V below = larger(V(0.0), reach - difference.centre);
  const V sum = above + below;
  const V quotient = below / select(sum > V(0.0), sum, V(1.0));
  const V share = -larger(V(-1.0), -quotient);
  const V other = V(1.0) - share;
  const V half = V(0.5) * larger(other * below, share * above);
  const V size_a = magnitude(a.centre) + magnitude(a.slope);
  const V size_b = magnitude(b.centre) + magnitude(b.slope);
  return {(share * a.centre + other * b.centre) - half, share * a.slope + other * b.slope,
          ((share * a.error + other * b.error) + half) + (V(0x1p-49) * ((size_a + size_b) + half) + V(tiny))};
}
template <class V>
BACKLIGHT_LANES LaneAffine<V> maximum(LaneAffine<V> a, LaneAffine<V> b) {
  return -minimum(-a, -b);
}
template <class V>
BACKLIGHT_LANES LaneAffine<V> abs(LaneAffine<V> a) {
  return -minimum(a, -a);
}

/// √x = √c (1 + δ/2 - R) about the centre c, R = δ²/(2 (1 + √(1 + δ))²) at most what it is at δ = -ρ.
template <class V>
BACKLIGHT_LANES LaneAffine<V> sqrt(LaneAffine<V> a) {
  const V reach = radius(a);
  const V minus_least = reach - a.centre;
  if (bits(~(minus_least <= V(0.0))) != 0) note_trouble();
  const auto positive = a.centre > V(0.0);
  const V centre = select(positive, a.centre, V(1.0));
  const V root = select(positive, sqrt(centre), V(0.0));
  const V inverse = V(0.5) / select(positive, root, V(1.0));
  // √(1 - ρ), not too large
  const V below = select(minus_least < V(0.0), -minus_least, V(0.0));
  const V end = V(1.0) + V(1.0 - 0x1p-49) * sqrt(below / centre);
  const V part = reach / centre;
  const V bend = V(0x1.0001p0) * ((V(0.5) * (part * part)) / (end * end));
  const V half = V(0.5) * bend;
  return {root - root * half, inverse * a.slope,
          ((inverse * a.error + root * half) * V(1.0 + 0x1p-49) + V(0x1p-48) * root) + V(tiny)};
}

/// About the centre c, with r = |slope| + error: sin(c+d) = sin c + d cos c - d²/2 sin c ± r³/6, where
/// d² = r²/2 ± r²/2; likewise the cosine, as sin(c + π/2 + d).
template <class V>
BACKLIGHT_LANES LaneAffine<V> wave_about(V value, V rate, LaneAffine<V> a) {
  const V reach = radius(a);
  const V square = reach * reach;
  const V quarter = V(0.25) * square;
  const V rounding = V(wave_error + 0x1p-50) * ((V(1.0) + reach) + square) + V(tiny);
  const V error = ((magnitude(rate) * a.error + magnitude(value) * quarter) +
                   (square * reach) * V(0x1.5555555555556p-3)) +
                  rounding;
  const LaneAffine<V> form{value - value * quarter, rate * a.slope, error};
  return select(error < V(1.0), form, LaneAffine<V>(V(0.0), V(0.0), V(1.0)));
}

template <class V>
BACKLIGHT_LANES LaneAffine<V> library(Operation operation, LaneAffine<V> a, LaneAffine<V> b) {
  double of[9][V::width];
  a.centre.store(of[0]);
  a.slope.store(of[1]);
  a.error.store(of[2]);
  b.centre.store(of[3]);
  b.slope.store(of[4]);
  b.error.store(of[5]);
  affine_of_each(operation, V::width, of[0], of[6]);
  return {V::load(of[6]), V::load(of[7]), V::load(of[8])};
}

template <class V>
BACKLIGHT_LANES auto near_enough_for_waves(LaneAffine<V> a) {
  return magnitude(a.centre) <= V(largest_wave_argument);
}
template <class V>
BACKLIGHT_LANES LaneAffine<V> sin(LaneAffine<V> a) {
  return wave(
      Operation::sin, a, near_enough_for_waves(a), [](LaneAffine<V> near) __attribute__((always_inline)) {
        const Waves<V> at = waves(near.centre);
        return wave_about(at.sine, at.cosine, near);
      });
}
template <class V>
BACKLIGHT_LANES LaneAffine<V> cos(LaneAffine<V> a) {
  return wave(
      Operation::cos, a, near_enough_for_waves(a), [](LaneAffine<V> near) __attribute__((always_inline)) {
        const Waves<V> at = waves(near.centre);
        return wave_about(at.cosine, -at.sine, near);
      });
}

// The functions that are computed one lane at a time.
#define BACKLIGHT_ONE_BY_ONE(name)                      \
  template <class V>                                    \
  BACKLIGHT_LANES LaneAffine<V> name(LaneAffine<V> a) { \
    return library(Operation::name, a, a);              \
  }
BACKLIGHT_LIBRARY_FUNCTIONS(BACKLIGHT_ONE_BY_ONE)
#undef BACKLIGHT_ONE_BY_ONE

#define BACKLIGHT_TWO_BY_TWO(name, operation)                            \
  template <class V>                                                     \
  BACKLIGHT_LANES LaneAffine<V> name(LaneAffine<V> a, LaneAffine<V> b) { \
    return library(Operation::operation, a, b);                          \
  }
BACKLIGHT_LIBRARY_FUNCTIONS_OF_TWO(BACKLIGHT_TWO_BY_TWO)
#undef BACKLIGHT_TWO_BY_TWO

/// A piece of a line as middle + half·ε: s in [from, to] for |ε| <= 1.
template <class V>
struct LanePiece {
  V middle, half;

  BACKLIGHT_LANES LanePiece(V from, V to)
      : middle(V(0.5) * (from + to)), half(larger(to - middle, middle - from)) {}
};

/// origin + s direction.
template <class V>
BACKLIGHT_LANES LaneAffine<V> on_line(V origin, V direction, V from, V to, LaneAffine<V>*) {
  const LanePiece<V> piece(from, to);
  const V along = piece.middle * direction;
  const V centre = origin + along;
  const V slope = piece.half * direction;
  return {centre, slope,
          V(rounding_unit) * ((magnitude(along) + magnitude(centre)) + magnitude(slope)) + V(tiny)};
}

/// Where |centre + slope ε| may be as small as the error. `sign` is that of the form at ε = -1, `none` where
/// it stays off zero.
template <class V>
struct LaneZeros {
  V first, last, sign;
  typename V::Mask none;
};

template <class V>
BACKLIGHT_LANES LaneZeros<V> zeros_of(LaneAffine<V> f, V from, V to) {
  const LanePiece<V> piece(from, to);
  const V one(1.0);
  // As if the slope were positive.
  const auto falling = f.slope < V(0.0);
  const V centre = select(falling, -f.centre, f.centre);
  const V slope = magnitude(f.slope);
  const V divisor = select(slope > V(0.0), slope, one);
  const auto end = [&](V numerator) {  // rounded up
    const V inside = larger(numerator, -slope);
    return select(inside < slope, select(inside < slope, inside, slope) / divisor, one);
  };
  const V minus_low = end(f.error + centre);
  const V high = end(f.error - centre);
  const V first = larger(from, -(minus_low * piece.half - piece.middle));
  const V last = -larger(-to, -(high * piece.half + piece.middle));
  const auto none = magnitude(f.centre) > slope + f.error;
  const V before = select(falling, one, -one);
  return {first, last, select(none, select(f.centre > V(0.0), one, -one), before), none};
}

}  // namespace backlight
