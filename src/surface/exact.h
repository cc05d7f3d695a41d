// Sums and products of two doubles together with their rounding errors. Plain arithmetic, so that the bits
// are the same on every machine and a version over SIMD lanes can do the same. Knuth (two_sum), Veltkamp and
// Dekker (split, two_product): T. J. Dekker, "A floating-point technique for extending the available
// precision", 1971.
#pragma once

namespace backlight {

/// value + error is the exact result.
struct TwoPart {
  double value;
  double error;
};

inline TwoPart two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// a = value + error, each with at most 26 significant bits. |a| < 2^996.
inline TwoPart split(double a) {
  const double scaled = 134217729.0 * a;  // 2^27 + 1
  const double high = scaled - (scaled - a);
  return {high, a - high};
}

inline TwoPart two_product(double a, double b, const TwoPart& a_split, const TwoPart& b_split) {
  const double product = a * b;
  const double error = ((a_split.value * b_split.value - product) + a_split.value * b_split.error +
                        a_split.error * b_split.value) +
                       a_split.error * b_split.error;
  return {product, error};
}

inline TwoPart two_product(double a, double b) {
  return two_product(a, b, split(a), split(b));
}

/// a·b - c·d, to about one rounding of the result even when the products cancel.
inline double difference_of_products(double a, double b, double c, double d) {
  const TwoPart ab = two_product(a, b);
  const TwoPart cd = two_product(c, d);
  return (ab.value - cd.value) + (ab.error - cd.error);
}

}  // namespace backlight
