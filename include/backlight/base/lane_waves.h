// Sine and cosine over lanes: the same bits for one lane and for four, with a proven bound of the error in
// any rounding mode.
//
// The argument is reduced by three pieces of π/2 (Cody & Waite, 1980), of which the first two have 33 bits,
// so that for fewer than 2²⁰ quarter turns the products are exact; each of the two rounded subtractions is
// wrong by one unit in the last place below 1 at most, 1.1e-16. On [-π/4, π/4] the Taylor sums to x¹⁷/17! and
// x¹⁶/16! are cut off by less than 4e-18; rounding of their last two operations adds 2.2e-16, of the others
// 4e-17. Together less than 5.2e-16. (tests/unit/expression compares with MPFR.)
#pragma once

#include "backlight/base/lanes.h"

namespace backlight {

/// The error of sine and cosine is below this, in any rounding mode.
inline constexpr double wave_error = 6.0e-16;

/// |x| must not be above this.
inline constexpr double largest_wave_argument = 1.6e6;

template <class V>
struct Waves {
  V sine, cosine;
  V quarters;  ///< x / (π/2), rounded to some nearest whole number
};

/// A whole number within 1/2 (and a rounding) of x, in any rounding mode; |x| < 2⁵¹.
template <class V>
BACKLIGHT_LANES V nearest_whole(V x) {
  const V magic(6755399441055744.0);  // 3·2⁵¹: adding it pushes all binary places out
  V whole = (x + magic) - magic;
  const V off = x - whole;
  whole = select(off > V(0.5), whole + V(1.0), whole);
  return select(off < V(-0.5), whole - V(1.0), whole);
}

/// The largest whole number not above x; |x| < 2⁵¹.
template <class V>
BACKLIGHT_LANES V floor_of(V x) {
  const V magic(6755399441055744.0);
  const V whole = (x + magic) - magic;
  return select(whole > x, whole - V(1.0), whole);
}

template <class V>
BACKLIGHT_LANES V taylor_sine(V r, V square) {
  V sum(1.0 / 355687428096000.0);
  sum = sum * square - V(1.0 / 1307674368000.0);
  sum = sum * square + V(1.0 / 6227020800.0);
  sum = sum * square - V(1.0 / 39916800.0);
  sum = sum * square + V(1.0 / 362880.0);
  sum = sum * square - V(1.0 / 5040.0);
  sum = sum * square + V(1.0 / 120.0);
  sum = sum * square - V(1.0 / 6.0);
  return r + (r * square) * sum;
}

template <class V>
BACKLIGHT_LANES V taylor_cosine(V square) {
  V sum(1.0 / 20922789888000.0);
  sum = sum * square - V(1.0 / 87178291200.0);
  sum = sum * square + V(1.0 / 479001600.0);
  sum = sum * square - V(1.0 / 3628800.0);
  sum = sum * square + V(1.0 / 40320.0);
  sum = sum * square - V(1.0 / 720.0);
  sum = sum * square + V(1.0 / 24.0);
  return V(1.0) - (V(0.5) * square - (square * square) * sum);
}

template <class V>
BACKLIGHT_LANES Waves<V> waves(V x) {
  const V two_over_pi(0.63661977236758134308);
  const V quarters = nearest_whole(x * two_over_pi);
  // π/2 = first + second + third, 33 + 33 + 53 bits.
  const V r = ((x - quarters * V(0x1.921fb544p+0)) - quarters * V(0x1.0b4611a6p-34)) -
              quarters * V(0x1.3198a2e037073p-69);
  const V square = r * r;
  const V sine = taylor_sine(r, square);
  const V cosine = taylor_cosine(square);
  const V turn = quarters - V(4.0) * floor_of(quarters * V(0.25));  // 0, 1, 2, 3
  const auto odd = (turn == V(1.0)) | (turn == V(3.0));
  const V s = select(odd, cosine, sine);
  const V c = select(odd, sine, cosine);
  return {select(turn >= V(2.0), -s, s), select((turn == V(1.0)) | (turn == V(2.0)), -c, c), quarters};
}

}  // namespace backlight
