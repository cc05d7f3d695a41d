// The matrices between CIE XYZ and linear Rec.709, derived at compile time.
#pragma once

#include <array>

#include "cie_tables.h"

namespace backlight::rec709 {

using Matrix = std::array<std::array<double, 3>, 3>;  ///< rows

constexpr cie::Tristimulus multiply(const Matrix& m, const cie::Tristimulus& v) {
  return {m[0][0] * v[0] + m[0][1] * v[1] + m[0][2] * v[2], m[1][0] * v[0] + m[1][1] * v[1] + m[1][2] * v[2],
          m[2][0] * v[0] + m[2][1] * v[1] + m[2][2] * v[2]};
}

/// The inverse by cofactors.
constexpr Matrix inverse(const Matrix& m) {
  const auto cofactor = [&m](std::size_t r, std::size_t c) {
    const std::size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double determinant = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
  Matrix result{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) result[r][c] = cofactor(c, r) / determinant;
  }
  return result;
}

/// XYZ of red, green and blue in the columns, scaled so that (1, 1, 1) is the D65 white.
constexpr Matrix derive_xyz_from_rgb() {
  constexpr double x[3] = {0.64, 0.30, 0.15};
  constexpr double y[3] = {0.33, 0.60, 0.06};
  Matrix primaries{};
  for (std::size_t c = 0; c < 3; ++c) {
    primaries[0][c] = x[c] / y[c];
    primaries[1][c] = 1.0;
    primaries[2][c] = (1.0 - x[c] - y[c]) / y[c];
  }
  const cie::Tristimulus amount = multiply(inverse(primaries), cie::d65_white());
  for (auto& row : primaries) {
    for (std::size_t c = 0; c < 3; ++c) row[c] *= amount[c];
  }
  return primaries;
}

inline constexpr Matrix xyz_from_rgb = derive_xyz_from_rgb();
inline constexpr Matrix rgb_from_xyz = inverse(xyz_from_rgb);

/// For each nanometre from 360 to 830 the weight of a radiance in the film's red, green and blue. The sum
/// over a spectrum is its film colour to the CIE's own definition; D65 (1 at 560 nm) gives (1, 1, 1).
constexpr std::array<cie::Tristimulus, cie::sample_count> derive_film_weights() {
  const double normalisation = 1.0 / cie::d65_tristimulus()[1];
  std::array<cie::Tristimulus, cie::sample_count> weights{};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = multiply(rgb_from_xyz, cie::observer_1931[i]);
    for (double& weight : weights[i]) weight *= normalisation;
  }
  return weights;
}

inline constexpr std::array<cie::Tristimulus, cie::sample_count> film_weights = derive_film_weights();

}  // namespace backlight::rec709
