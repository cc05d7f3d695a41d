// Sums and products of two numbers together with their rounding errors, of doubles or of lanes of them. Plain
// arithmetic, so that the bits are the same on every machine and for any number of lanes. Knuth (two_sum),
// Veltkamp and Dekker (split, two_product): T. J. Dekker, "A floating-point technique for extending the
// available precision", 1971.
#pragma once

#include "backlight/base/lanes.h"

namespace backlight {

/// value + error is the exact result.
template <class T>
struct TwoPart {
  T value;
  T error;
};

template <class T>
BACKLIGHT_LANES TwoPart<T> two_sum(T a, T b) {
  const T sum = a + b;
  const T b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// a = value + error, each with at most 26 significant bits. |a| < 2^996.
template <class T>
BACKLIGHT_LANES TwoPart<T> split(T a) {
  const T scaled = T(134217729.0) * a;  // 2^27 + 1
  const T high = scaled - (scaled - a);
  return {high, a - high};
}

template <class T>
BACKLIGHT_LANES TwoPart<T> two_product(T a, T b, const TwoPart<T>& a_split, const TwoPart<T>& b_split) {
  const T product = a * b;
  const T error = ((a_split.value * b_split.value - product) + a_split.value * b_split.error +
                   a_split.error * b_split.value) +
                  a_split.error * b_split.error;
  return {product, error};
}

/// a·b - c·d, to about one rounding of the result even when the products cancel.
template <class T>
BACKLIGHT_LANES T difference_of_products(T a, T b, T c, T d) {
  const TwoPart<T> ab = two_product(a, b, split(a), split(b));
  const TwoPart<T> cd = two_product(c, d, split(c), split(d));
  return (ab.value - cd.value) + (ab.error - cd.error);
}

}  // namespace backlight
