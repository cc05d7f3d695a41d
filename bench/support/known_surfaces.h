// Surfaces that root finders are tried on, each formula written once, for numbers of any type: double,
// precise numbers, polynomials (which multiply it out), and text (which writes it for Backlight and for
// POV-Ray).
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "support/precise.h"

namespace backlight::bench {

/// The terms of a polynomial in x, y, z by their exponents.
struct Monomials {
  std::map<std::array<int, 3>, double> terms;
  Monomials() = default;
  Monomials(double constant) : terms{{{0, 0, 0}, constant}} {}  // NOLINT: a number is a polynomial
  [[nodiscard]] int degree() const;
};
Monomials operator+(Monomials a, const Monomials& b);
Monomials operator-(Monomials a, const Monomials& b);
Monomials operator*(const Monomials& a, const Monomials& b);

/// The same formula in two languages.
struct Formula {
  std::string backlight, povray;
  Formula(std::string ours, std::string theirs) : backlight(std::move(ours)), povray(std::move(theirs)) {}
  Formula(double constant);  // NOLINT: a number is a formula
};
Formula operator+(const Formula& a, const Formula& b);
Formula operator-(const Formula& a, const Formula& b);
Formula operator*(const Formula& a, const Formula& b);
Formula sin(const Formula& a);
Formula cos(const Formula& a);

inline double square(double a) {
  return a * a;
}
inline Precise square(const Precise& a) {
  return a * a;
}
inline Monomials square(const Monomials& a) {
  return a * a;
}
Formula square(const Formula& a);

struct KnownSurface {
  const char* name;
  double half;  ///< of the cube about the origin that cuts it out
  double (*value)(double, double, double);
  Precise (*precise)(const Precise&, const Precise&, const Precise&);
  Formula formula;
  Monomials monomials;  ///< empty where it is none
  int closed_form;      ///< 0: none, 1: torus, 2: sphere
};

std::vector<KnownSurface> known_surfaces();

/// The coordinates as text.
Formula coordinate(const char* name);

}  // namespace backlight::bench
