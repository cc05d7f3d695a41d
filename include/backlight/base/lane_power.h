// x^y for 0 <= x, y >= 0 over lanes: the one power that a ray needs (Phong's lobe), with the same bits for
// any number of lanes, which libm's does not promise.
//
// log2 x = e + log2 m with m in [1/√2, √2), by the series of the inverse hyperbolic tangent in
// s = (m-1)/(m+1); 2^t by Taylor's series about the nearest whole number. Both series leave less than one
// rounding. The relative error of the result is below 4 |y log2 x| + 8 units of 2^-53: the rounding of the
// logarithm, times what the exponential makes of it (measured in tests/unit/colour).
#pragma once

#include "backlight/base/lanes.h"

namespace backlight {

template <int N>
BACKLIGHT_LANES Lanes<N> log2_of_positive(Lanes<N> x) {
  using V = Lanes<N>;
  using I = typename LaneMask<N>::Vec;
  const I raw = (I)x.v;
  // Adding what is between 1/√2 and 1 makes the exponent that of the nearest power of two.
  const I shifted = raw + (0x3ff0000000000000LL - 0x3fe6a09e667f3bcdLL);
  const I exponent = (shifted >> 52) - 1023;
  const V m = (typename V::Vec)(raw - (exponent << 52));
  // A whole number of 11 bits as a double, without a conversion: in the last bits of 3·2^51.
  const V whole = V((typename V::Vec)(exponent + 0x4338000000000000LL)) - V(0x1.8p52);
  const V s = (m - V(1.0)) / (m + V(1.0));
  const V q = s * s;
  V sum = 1.0 / 21.0;
  sum = sum * q + V(1.0 / 19.0);
  sum = sum * q + V(1.0 / 17.0);
  sum = sum * q + V(1.0 / 15.0);
  sum = sum * q + V(1.0 / 13.0);
  sum = sum * q + V(1.0 / 11.0);
  sum = sum * q + V(1.0 / 9.0);
  sum = sum * q + V(1.0 / 7.0);
  sum = sum * q + V(1.0 / 5.0);
  sum = sum * q + V(1.0 / 3.0);
  sum = sum * q * s + s;
  return whole + sum * V(2.8853900817779268147);  // 2/ln 2
}

/// 2^t for t <= 0; 0 below 2^-1022.
template <int N>
BACKLIGHT_LANES Lanes<N> exp2_of_negative(Lanes<N> t) {
  using V = Lanes<N>;
  using I = typename LaneMask<N>::Vec;
  const V possible = select(t >= V(-1022.0), t, V(-1022.0));
  const V shifted = possible + V(0x1.8p52);
  const V whole = shifted - V(0x1.8p52);
  const V z = (possible - whole) * V(0.69314718055994530942);
  V sum = 1.0 / 6227020800.0;
  sum = sum * z + V(1.0 / 479001600.0);
  sum = sum * z + V(1.0 / 39916800.0);
  sum = sum * z + V(1.0 / 3628800.0);
  sum = sum * z + V(1.0 / 362880.0);
  sum = sum * z + V(1.0 / 40320.0);
  sum = sum * z + V(1.0 / 5040.0);
  sum = sum * z + V(1.0 / 720.0);
  sum = sum * z + V(1.0 / 120.0);
  sum = sum * z + V(1.0 / 24.0);
  sum = sum * z + V(1.0 / 6.0);
  sum = sum * z + V(0.5);
  sum = sum * z * z + z;
  const I power = ((I)shifted.v - (I)V(0x1.8p52).v + 1023) << 52;
  const V scaled = (sum + V(1.0)) * V((typename V::Vec)power);
  return select(t >= V(-1022.0), scaled, V(0.0));
}

/// base^exponent for 0 < base <= 1 (and the few ulp above 1 that a cosine may have), exponent >= 0.
template <int N>
BACKLIGHT_LANES Lanes<N> power(Lanes<N> base, Lanes<N> exponent) {
  using V = Lanes<N>;
  const V possible = select(base >= V(0x1p-1022), base, V(0x1p-1022));
  return exp2_of_negative(exponent * log2_of_positive(possible));
}

/// The same of one pair of numbers.
inline double power(double base, double exponent) {
  return power(Lanes<2>(base), Lanes<2>(exponent)).v[0];
}

}  // namespace backlight
