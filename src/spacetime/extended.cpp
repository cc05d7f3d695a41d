#include "backlight/spacetime/extended.h"

namespace backlight {

Extended exp(Extended a) {
  if (!(std::abs(a.hi) <= 300.0)) return std::exp(a.hi);
  // e^a = 2^k (e^r)^512 with |r| <= ln2/1024, where 12 terms of Taylor's series leave less than 1e-40.
  constexpr Extended ln2{0.693147180559945286226764, 2.319046813846299558e-17};
  const double k = std::nearbyint(a.hi / ln2.hi);
  const Extended r = (a - Extended(k) * ln2) * Extended(1.0 / 512.0);
  // Sum e^r - 1, so that the squarings below act on a small number and do not amplify its rounding.
  Extended sum;
  for (int n = 12; n >= 1; --n) sum = (Extended(1.0) + sum) * r / Extended(double(n));
  for (int i = 0; i < 9; ++i) sum = sum * sum + Extended(2.0) * sum;
  const Extended result = Extended(1.0) + sum;
  const int exponent = static_cast<int>(k);
  return {std::ldexp(result.hi, exponent), std::ldexp(result.lo, exponent)};
}

Extended sinh(Extended a) {
  if (std::abs(a.hi) < 0.5) {  // the difference of exponentials cancels: sum the odd series
    const Extended square = a * a;
    Extended sum = 0.0;
    for (int n = 14; n >= 1; --n) {
      sum = square * (Extended(1.0) + sum) / Extended(double(2 * n) * double(2 * n + 1));
    }
    return a + a * sum;
  }
  const Extended e = exp(a);
  return Extended(0.5) * (e - Extended(1.0) / e);
}

Extended cosh(Extended a) {
  const Extended e = exp(a);
  return Extended(0.5) * (e + Extended(1.0) / e);
}

}  // namespace backlight
