#include "backlight/colour/film_integral.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "backlight/colour/observer.h"
#include "cie_sum.h"

namespace backlight {
namespace {

// Straight lines between points, kept beyond the ends: not the program's own.
struct Polyline {
  std::vector<double> nm;
  std::vector<double> values;

  [[nodiscard]] double at(double x) const {
    if (x <= nm.front()) return values.front();
    for (std::size_t i = 1; i < nm.size(); ++i) {
      if (x <= nm[i])
        return values[i - 1] + (values[i] - values[i - 1]) * (x - nm[i - 1]) / (nm[i] - nm[i - 1]);
    }
    return values.back();
  }
  [[nodiscard]] Spectrum spectrum() const { return *Spectrum::tabulated(nm, values).spectrum; }
};

Polyline triangle(double centre, double half_width) {
  return {{centre - half_width, centre, centre + half_width}, {0.0, 1.0, 0.0}};
}

LinearRgb film_weight(double nm) {
  return rgb_from_xyz(colour_matching_functions(nm)) / d65_sum();
}

// By the midpoint rule from `from` to `to`, of the camera's wavelengths.
template <class Value>
LinearRgb midpoints(double from, double to, const Value& value) {
  from = std::max(from, 360.0);
  to = std::min(to, 830.0);
  constexpr int steps = 200000;
  LinearRgb sum{0.0};
  for (int i = 0; i < steps; ++i) {
    const double nm = from + (i + 0.5) / steps * (to - from);
    sum += value(nm) * film_weight(nm);
  }
  return from < to ? sum * ((to - from) / steps) : LinearRgb{0.0};
}

void expect_same(const LinearRgb& actual, const LinearRgb& expected, double tolerance) {
  const double size = std::max({std::abs(expected.x), std::abs(expected.y), std::abs(expected.z)});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], tolerance * size + 1e-300) << c;
}

class RandomShifts {
 public:
  double shift() { return 0.5 * std::pow(4.0, unit()); }
  double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(engine_); }

 private:
  std::mt19937 engine_{7};
};

TEST(FilmIntegral, NarrowLampsAtAnyShift) {
  RandomShifts random;
  for (const double half_width : {0.01, 0.1, 0.4, 1.0, 5.0, 10.0, 20.0, 50.0}) {
    for (int i = 0; i < 6; ++i) {
      const double shift = random.shift(), centre = shift * (400.0 + 300.0 * random.unit());
      const Polyline lamp = triangle(centre, half_width);
      const LinearRgb exact = midpoints((centre - half_width) / shift, (centre + half_width) / shift,
                                        [&](double nm) { return lamp.at(shift * nm); });
      expect_same(integrate_film(lamp.spectrum(), shift), exact, 1e-7);
    }
  }
}

TEST(FilmIntegral, NarrowLampsOnNarrowReflectances) {
  RandomShifts random;
  for (const double lamp_width : {0.1, 2.0, 30.0}) {
    for (const double reflectance_width : {0.1, 3.0, 40.0}) {
      const double shift = random.shift(), d = random.shift(), centre = 450.0 + 200.0 * random.unit();
      const Polyline lamp = triangle(shift * centre, lamp_width);
      const double aside = 0.5 * std::min(lamp_width, reflectance_width);
      const Polyline surface = triangle(d * centre + aside, reflectance_width);
      const Spectrum reflectance = surface.spectrum();
      const LinearRgb exact =
          midpoints(std::max(centre - lamp_width / shift, centre + (aside - reflectance_width) / d),
                    std::min(centre + lamp_width / shift, centre + (aside + reflectance_width) / d),
                    [&](double nm) { return lamp.at(shift * nm) * surface.at(d * nm); });
      expect_same(integrate_film(lamp.spectrum(), shift, &reflectance, d), exact, 1e-6);
    }
  }
}

TEST(FilmIntegral, NarrowReflectancesUnderSmoothLight) {
  RandomShifts random;
  for (const Spectrum& lamp :
       {Spectrum::d65(), Spectrum::blackbody(3000.0), Spectrum::illuminant({1, 0.4, 0.2})}) {
    for (const double width : {0.2, 1.0, 8.0, 50.0}) {
      const double shift = random.shift(), d = random.shift(), centre = 450.0 + 200.0 * random.unit();
      const Polyline surface = triangle(d * centre, width);
      const Spectrum reflectance = surface.spectrum();
      const LinearRgb exact = midpoints(centre - width / d, centre + width / d,
                                        [&](double nm) { return lamp.at(shift * nm) * surface.at(d * nm); });
      expect_same(integrate_film(lamp, shift, &reflectance, d), exact, 3e-5);
    }
  }
}

TEST(FilmIntegral, NarrowLampsOnColours) {
  RandomShifts random;
  for (const LinearRgb& rgb : {LinearRgb{1, 0, 0}, {0, 1, 0}, {0.6, 0.25, 0.2}}) {
    const Spectrum surface = Spectrum::reflectance(rgb);
    for (const double width : {0.2, 5.0, 50.0}) {
      const double shift = random.shift(), d = random.shift(), centre = 450.0 + 200.0 * random.unit();
      const Polyline lamp = triangle(shift * centre, width);
      const LinearRgb exact = midpoints(centre - width / shift, centre + width / shift,
                                        [&](double nm) { return lamp.at(shift * nm) * surface.at(d * nm); });
      expect_same(integrate_film(lamp.spectrum(), shift, &surface, d), exact, 1e-5);
    }
  }
}

// A table of a thousand teeth, each narrower than the observer's nanometre.
TEST(FilmIntegral, Combs) {
  Polyline comb;
  for (int i = 0; i < 1000; ++i) {
    comb.nm.push_back(400.0 + 0.3 * i);
    comb.values.push_back(i % 2);
  }
  comb.values.back() = 0.0;
  const LinearRgb exact = midpoints(360.0, 830.0, [&](double nm) { return comb.at(1.1 * nm); });
  expect_same(integrate_film(comb.spectrum(), 1.1), exact, 1e-5);
}

// w(λ0/s) P/s ρ(D λ0/s), to the last digits.
TEST(FilmIntegral, Lines) {
  const Spectrum lamp = *Spectrum::tabulated({}, {}, {589.6, 589.0, 121.6}, {1.0, 2.0, 50.0}).spectrum;
  const Spectrum surface = Spectrum::reflectance({0.9, 0.1, 0.05});
  for (const double shift : {0.2, 0.75, 1.0, 1.04, 1.5}) {
    LinearRgb whole{0.0}, reflected{0.0};
    for (const auto& [nm, power] : {std::pair{589.6, 1.0}, {589.0, 2.0}, {121.6, 50.0}}) {
      const LinearRgb light = power / shift * film_weight(nm / shift);
      whole += light;
      reflected += surface.at(0.9 * nm / shift) * light;
    }
    expect_same(integrate_film(lamp, shift), whole, 1e-13);
    expect_same(integrate_film(lamp, shift, &surface, 0.9), reflected, 1e-13);
  }
  EXPECT_EQ(lamp.at(589.0), 0.0);
  expect_same(film_colour(lamp.scaled(3.0)), 3.0 * film_colour(lamp), 1e-15);
}

TEST(FilmIntegral, LinesBesideATable) {
  const Spectrum both = *Spectrum::tabulated({400, 700}, {0.5, 0.5}, {500.0}, {30.0}).spectrum;
  const Spectrum table = *Spectrum::tabulated({400, 700}, {0.5, 0.5}).spectrum;
  expect_same(film_colour(both), film_colour(table) + 30.0 * film_weight(500.0), 1e-13);
}

TEST(FilmIntegral, ConstantTablesAreConstants) {
  const Spectrum half = *Spectrum::tabulated({500, 600}, {0.5, 0.5}).spectrum;
  EXPECT_TRUE(half.is_grey());
  // Nearly one, so that it is integrated: the coldest bodies too, whose light changes within a nanometre.
  const Spectrum nearly = *Spectrum::tabulated({500, 600}, {0.5, 0.5 + 1e-12}).spectrum;
  for (const double kelvin : {100.0, 200.0, 1000.0, 6000.0}) {
    const Spectrum body = Spectrum::blackbody(kelvin);
    expect_same(colour_under(body, nearly), 0.5 * film_colour(body), kelvin < 500.0 ? 1e-3 : 1e-4);
  }
}

TEST(FilmIntegral, TheRuleAtRestIsTheIntegral) {
  const Spectrum lamp = *Spectrum::tabulated({450, 455, 600}, {0, 1, 0}, {589.0}, {2.0}).spectrum;
  const Spectrum surface = Spectrum::reflectance({0.2, 0.7, 0.1});
  const FilmQuadrature rule = film_quadrature(lamp);
  LinearRgb sum{0.0};
  for (std::size_t i = 0; i < rule.nm.size(); ++i) sum += surface.at(rule.nm[i]) * rule.weight[i];
  expect_same(sum, colour_under(lamp, surface), 1e-14);
}

TEST(FilmIntegral, OutsideTheVisibleThereIsNothing) {
  const Spectrum lamp = *Spectrum::tabulated({587, 589, 591}, {0, 1, 0}, {589.0}, {1.0}).spectrum;
  for (const double shift : {1e-9, 0.1, 2.0, 1e9}) EXPECT_EQ(integrate_film(lamp, shift), LinearRgb{0.0});
}

}  // namespace
}  // namespace backlight
