// Double-double arithmetic: an unevaluated sum of two doubles, about 32 decimal digits.
//
// For setting up frames, once per image: composing two boosts of Lorentz factor g in double loses g² ulps
// (docs/physics.md section 6). Of a ray, only what happens in a frame of large γ is worth its price.
//
// The error-free transformations are Knuth's two-sum and the fused product; sums and products follow
// Joldes, Muller & Popescu, "Tight and rigorous error bounds for basic building blocks of double-word
// arithmetic", ACM TOMS 44(2), 2017 (relative errors of a few 2^-104).
#pragma once

#include <array>
#include <cmath>

#include "backlight/base/vector.h"

namespace backlight {

/// hi + lo with |lo| <= ulp(hi)/2.
struct Extended {
  double hi = 0.0;
  double lo = 0.0;

  constexpr Extended() = default;
  constexpr Extended(double value) : hi(value) {}  // NOLINT: a double is an Extended
  constexpr Extended(double high, double low) : hi(high), lo(low) {}

  /// The nearest double.
  explicit constexpr operator double() const { return hi + lo; }
  friend constexpr bool operator==(const Extended&, const Extended&) = default;
};

namespace detail {

constexpr Extended fast_two_sum(double a, double b) {  // |a| >= |b|
  const double s = a + b;
  return {s, b - (s - a)};
}

constexpr Extended two_sum(double a, double b) {
  const double s = a + b;
  const double bb = s - a;
  return {s, (a - (s - bb)) + (b - bb)};
}

inline Extended two_product(double a, double b) {
  const double p = a * b;
  return {p, std::fma(a, b, -p)};
}

}  // namespace detail

constexpr Extended operator-(Extended a) {
  return {-a.hi, -a.lo};
}

constexpr Extended operator+(Extended a, Extended b) {
  const Extended s = detail::two_sum(a.hi, b.hi);
  const Extended t = detail::two_sum(a.lo, b.lo);
  const Extended v = detail::fast_two_sum(s.hi, s.lo + t.hi);
  return detail::fast_two_sum(v.hi, t.lo + v.lo);
}

constexpr Extended operator-(Extended a, Extended b) {
  return a + (-b);
}

inline Extended operator*(Extended a, Extended b) {
  const Extended p = detail::two_product(a.hi, b.hi);
  const double cross = std::fma(a.hi, b.lo, std::fma(a.lo, b.hi, a.lo * b.lo));
  return detail::fast_two_sum(p.hi, p.lo + cross);
}

inline Extended operator/(Extended a, Extended b) {
  const double first = a.hi / b.hi;
  const Extended rest = a - b * Extended(first);
  const double second = rest.hi / b.hi;
  const Extended rest2 = rest - b * Extended(second);
  return detail::fast_two_sum(first, second) + Extended(rest2.hi / b.hi);
}

constexpr bool operator<(Extended a, Extended b) {
  return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo);
}

/// Square root; one Newton step from the double root. NaN for negative arguments, as std::sqrt.
inline Extended sqrt(Extended a) {
  if (a.hi == 0.0) return {};
  const double root = std::sqrt(a.hi);
  const Extended square = detail::two_product(root, root);
  const double correction = (a - square).hi / (2.0 * root);
  return detail::fast_two_sum(root, correction);
}

/// e^a, relative error below 1e-29 for |a| <= 300; NaN or infinity as std::exp beyond.
Extended exp(Extended a);

/// sinh and cosh: celerity and Lorentz factor of a rapidity. Same accuracy as exp.
Extended sinh(Extended a);
Extended cosh(Extended a);

/// Three Extended components.
struct ExtendedVec3 {
  std::array<Extended, 3> v{};

  ExtendedVec3() = default;
  ExtendedVec3(Extended x, Extended y, Extended z) : v{x, y, z} {}
  explicit ExtendedVec3(const Vec3& a) : v{a.x, a.y, a.z} {}

  Extended& operator[](int i) { return v[static_cast<std::size_t>(i)]; }
  const Extended& operator[](int i) const { return v[static_cast<std::size_t>(i)]; }
  [[nodiscard]] Vec3 rounded() const { return {double(v[0]), double(v[1]), double(v[2])}; }
  friend bool operator==(const ExtendedVec3&, const ExtendedVec3&) = default;
};

inline ExtendedVec3 operator+(const ExtendedVec3& a, const ExtendedVec3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

inline ExtendedVec3 operator-(const ExtendedVec3& a, const ExtendedVec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline ExtendedVec3 operator*(Extended s, const ExtendedVec3& a) {
  return {s * a[0], s * a[1], s * a[2]};
}

inline Extended dot(const ExtendedVec3& a, const ExtendedVec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace backlight
