// e^x over lanes, with the same bits for any number of lanes, which libm's does not promise.
//
// x = k ln 2 + r with |r| <= ln(2)/2; k ln 2 is taken off in two pieces (Cody & Waite, 1980), of which the
// first has 32 bits, so that its product with k (11 bits) is exact; e^r - 1 is Taylor's series to r^13/13!,
// cut off by less than 4e-18. The relative error of e^x is below 4 units of 2^-53, that of 1 - e^-x below 6
// (measured in tests/unit/base against 50 digits).
#pragma once

#include "backlight/base/lanes.h"

namespace backlight {

/// e^x as power (1 + rest): `power` a power of two, 0 below e^-708 and infinite above e^709; |rest| < 0.42.
template <int N>
struct LaneExponential {
  Lanes<N> power;
  Lanes<N> rest;

  [[nodiscard]] BACKLIGHT_LANES Lanes<N> value() const { return power * (Lanes<N>(1.0) + rest); }
  /// 1 - e^x, without loss of digits for x <= 0 near 0.
  [[nodiscard]] BACKLIGHT_LANES Lanes<N> complement() const { return (Lanes<N>(1.0) - power) - power * rest; }
};

template <int N>
BACKLIGHT_LANES LaneExponential<N> exponential(Lanes<N> x) {
  using V = Lanes<N>;
  using I = typename LaneMask<N>::Vec;
  const auto finite = (x >= V(-708.0)) & (x <= V(709.0));
  const V possible = select(finite, x, V(0.0));
  const V shifted = possible * V(1.4426950408889634074) + V(0x1.8p52);
  const V whole = shifted - V(0x1.8p52);
  const V r = (possible - whole * V(0x1.62e42feep-1)) - whole * V(0x1.a39ef35793c76p-33);
  V sum = 1.0 / 6227020800.0;
  sum = sum * r + V(1.0 / 479001600.0);
  sum = sum * r + V(1.0 / 39916800.0);
  sum = sum * r + V(1.0 / 3628800.0);
  sum = sum * r + V(1.0 / 362880.0);
  sum = sum * r + V(1.0 / 40320.0);
  sum = sum * r + V(1.0 / 5040.0);
  sum = sum * r + V(1.0 / 720.0);
  sum = sum * r + V(1.0 / 120.0);
  sum = sum * r + V(1.0 / 24.0);
  sum = sum * r + V(1.0 / 6.0);
  sum = sum * r + V(0.5);
  const V rest = sum * (r * r) + r;
  const V power = (typename V::Vec)(((I)shifted.v - (I)V(0x1.8p52).v + 1023) << 52);
  return {select(finite, power, select(x > V(0.0), V(__builtin_inf()), V(0.0))), rest};
}

}  // namespace backlight
