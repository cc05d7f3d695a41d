// A formula made of + - * and powers, along pieces of many straight lines, as what it is there: polynomials.
#pragma once

#include <cstddef>

namespace backlight {

/// Polynomials as arrays. Along line i, s = from + half (1 + ε) with ε in [-1, 1] covers the piece, and the
/// expression is Σ coefficient[k][i] εᵏ to within error[i], where the error is itself a polynomial of the
/// same degree, the magnitudes of whose coefficients sum up to no more than error[i]. Where a number was too
/// large for a double, `error` is infinite or not a number.
struct LinePolynomials {
  static constexpr std::size_t most = 64;  ///< lines
  static constexpr int most_degree = 12;

  int degree = 0;
  alignas(64) double coefficient[most_degree + 1][most];
  alignas(64) double error[most];
  alignas(64) double half[most];
};

}  // namespace backlight
