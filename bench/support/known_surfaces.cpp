#include "support/known_surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace backlight::bench {
namespace {

std::string written(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return value < 0.0 ? "(" + std::string(text) + ")" : text;
}

template <class T>
T sphere(const T& x, const T& y, const T& z) {
  return square(x) + square(y) + square(z) - T(1.0);
}

template <class T>
T torus(const T& x, const T& y, const T& z) {
  return square(square(x) + square(y) + square(z) + T(0.91)) - T(4.0) * (square(x) + square(z));
}

template <class T>
T steiner(const T& x, const T& y, const T& z) {
  return square(x) * square(y) + square(y) * square(z) + square(z) * square(x) - x * y * z;
}

template <class T>
T barth(const T& x, const T& y, const T& z) {
  const T a(2.618033988749895), b(4.23606797749979);
  return T(4.0) * (a * square(x) - square(y)) * (a * square(y) - square(z)) * (a * square(z) - square(x)) -
         b * square(square(x) + square(y) + square(z) - T(1.0));
}

template <class T>
T klein(const T& x, const T& y, const T& z) {
  const T s = square(x) + square(y) + square(z) - T(1.0), d = s - T(2.0) * y;
  return (s + T(2.0) * y) * (square(d) - T(8.0) * square(z)) + T(16.0) * x * z * d;
}

template <class T>
T chebyshev8(const T& x) {
  return T(2.0) * square(T(2.0) * square(T(2.0) * square(x) - T(1.0)) - T(1.0)) - T(1.0);
}

template <class T>
T chmutov(const T& x, const T& y, const T& z) {
  return chebyshev8(x) + chebyshev8(y) + chebyshev8(z) + T(1.0);
}

// By Horner's rule, in the squares.
template <class T>
T expanded8(const T& x) {
  const T s = square(x);
  return (((T(128.0) * s - T(256.0)) * s + T(160.0)) * s - T(32.0)) * s + T(1.0);
}

template <class T>
T chmutov_expanded(const T& x, const T& y, const T& z) {
  return expanded8(x) + expanded8(y) + expanded8(z) + T(1.0);
}

template <class T>
T gyroid(const T& x, const T& y, const T& z) {
  using std::cos;
  using std::sin;
  return sin(x) * cos(y) + sin(y) * cos(z) + sin(z) * cos(x);
}

// Of one template: each number type's instance.
#define BACKLIGHT_KNOWN(name, half, function, closed)                                           \
  KnownSurface {                                                                                \
    name, half, [](double x, double y, double z) { return function<double>(x, y, z); },         \
        [](const Precise& x, const Precise& y, const Precise& z) { return function(x, y, z); }, \
        function(coordinate("x"), coordinate("y"), coordinate("z")), {}, closed                 \
  }

Monomials unit(int axis) {
  Monomials m;
  std::array<int, 3> exponents{};
  exponents[static_cast<std::size_t>(axis)] = 1;
  m.terms[exponents] = 1.0;
  return m;
}

Formula joined(const Formula& a, const char* operation, const Formula& b) {
  return {"(" + a.backlight + operation + b.backlight + ")", "(" + a.povray + operation + b.povray + ")"};
}

Formula called(const char* function, const Formula& a) {
  const std::string name(function);
  return {name + "(" + a.backlight + ")", name + "(" + a.povray + ")"};
}

}  // namespace

int Monomials::degree() const {
  int most = 0;
  for (const auto& [e, c] : terms) most = std::max(most, e[0] + e[1] + e[2]);
  return most;
}

Monomials operator+(Monomials a, const Monomials& b) {
  for (const auto& [e, c] : b.terms) a.terms[e] += c;
  std::erase_if(a.terms, [](const auto& term) { return term.second == 0.0; });
  return a;
}

Monomials operator-(Monomials a, const Monomials& b) {
  return std::move(a) + Monomials(-1.0) * b;
}

Monomials operator*(const Monomials& a, const Monomials& b) {
  Monomials product;
  for (const auto& [e, c] : a.terms) {
    for (const auto& [f, d] : b.terms) product.terms[{e[0] + f[0], e[1] + f[1], e[2] + f[2]}] += c * d;
  }
  return product;
}

Formula::Formula(double constant) : backlight(written(constant)), povray(written(constant)) {}

Formula operator+(const Formula& a, const Formula& b) {
  return joined(a, "+", b);
}
Formula operator-(const Formula& a, const Formula& b) {
  return joined(a, "-", b);
}
Formula operator*(const Formula& a, const Formula& b) {
  return joined(a, "*", b);
}
Formula sin(const Formula& a) {
  return called("sin", a);
}
Formula cos(const Formula& a) {
  return called("cos", a);
}
Formula square(const Formula& a) {
  return {a.backlight + "^2", "pow(" + a.povray + ",2)"};
}

Formula coordinate(const char* name) {
  return {name, name};
}

std::vector<KnownSurface> known_surfaces() {
  std::vector<KnownSurface> all{
      BACKLIGHT_KNOWN("sphere", 1.1, sphere, 2),
      BACKLIGHT_KNOWN("torus", 1.4, torus, 1),
      BACKLIGHT_KNOWN("Steiner's surface", 0.6, steiner, 0),
      BACKLIGHT_KNOWN("Barth's sextic", 1.9, barth, 0),
      BACKLIGHT_KNOWN("Klein bottle", 4.0, klein, 0),
      BACKLIGHT_KNOWN("Chmutov's octic (composed)", 1.1, chmutov, 0),
      BACKLIGHT_KNOWN("Chmutov's octic (expanded)", 1.1, chmutov_expanded, 0),
      BACKLIGHT_KNOWN("gyroid", 6.0, gyroid, 0),
  };
  const Monomials x = unit(0), y = unit(1), z = unit(2);
  all[0].monomials = sphere(x, y, z);
  all[1].monomials = torus(x, y, z);
  all[2].monomials = steiner(x, y, z);
  all[3].monomials = barth(x, y, z);
  all[4].monomials = klein(x, y, z);
  all[6].monomials = chmutov_expanded(x, y, z);
  return all;
}

}  // namespace backlight::bench
