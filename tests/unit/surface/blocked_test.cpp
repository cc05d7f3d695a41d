// Whether a ray is blocked is what its first crossing says, to the last bit of λ, however many are asked
// together.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <variant>

#include "backlight/surface/implicit_surface.h"
#include "backlight/surface/surface_set.h"

namespace backlight {
namespace {

Shape formula_shape(const char* text, RootFinder finder) {
  auto parsed = Expression::parse(text, {"x", "y", "z", "t"});
  ImplicitOptions options;
  options.finder = finder;
  return implicit(std::make_shared<const ImplicitFormula>(std::get<Expression>(std::move(parsed))),
                  Vec3{-1.5}, Vec3{1.5}, options);
}

constexpr const char* barth = "4*(2.618*x^2-y^2)*(2.618*y^2-z^2)*(2.618*z^2-x^2)-4.236*(x^2+y^2+z^2-1)^2";
constexpr const char* gyroid = "sin(4*x)*cos(4*y)+sin(4*y)*cos(4*z)+sin(4*z)*cos(4*x)";
// Touched everywhere, so that every root is unresolved.
constexpr const char* twice = "(x^2+y^2+z^2-1)^2";

/// Rays from outside and from within, one in two of them of a length that λ = 1 lies among the surfaces.
struct Rays {
  static constexpr std::size_t count = 150;
  double origin[3][count];
  double direction[3][count];
  double time[count] = {};
  double rate[count] = {};

  Rays() {
    std::mt19937_64 generator(8);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < count; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        origin[axis][i] = (i % 3 == 0 ? 0.4 : 3.0) * normal(generator);
        const double target = 0.6 * normal(generator);
        direction[axis][i] = (i % 2 == 0 ? 1.0 : 0.1) * (target - origin[axis][i]);
      }
    }
  }
  /// The first 64 of them.
  [[nodiscard]] RaySheet sheet() const {
    RaySheet sheet;
    sheet.padded = sheet_size;
    for (std::size_t i = 0; i < sheet_size; ++i) {
      for (int k = 0; k < 3; ++k) {
        sheet.origin[k][i] = origin[k][i];
        sheet.direction[k][i] = direction[k][i];
      }
      sheet.length[i] = glm::length(along(i));
      sheet.start_time[i] = time[i];
      sheet.time_rate[i] = rate[i];
    }
    return sheet;
  }
  [[nodiscard]] Vec3 from(std::size_t i) const { return {origin[0][i], origin[1][i], origin[2][i]}; }
  [[nodiscard]] Vec3 along(std::size_t i) const {
    return {direction[0][i], direction[1][i], direction[2][i]};
  }
};

void expect_what_the_first_crossing_says(const Shape& shape) {
  SurfaceSet set;
  set.add(shape, Placement({0.1, -0.2, 0.05}, {10.0, 20.0, 30.0}));
  set.build();
  const Rays rays;
  int hits = 0;
  for (std::size_t i = 0; i < Rays::count; ++i) {
    const double lambda = set.nearest(rays.from(i), rays.along(i)).lambda;
    const auto blocked = [&](double end) { return set.blocked(rays.from(i), rays.along(i), end); };
    EXPECT_EQ(blocked(std::numeric_limits<double>::infinity()), std::isfinite(lambda)) << i;
    if (!std::isfinite(lambda)) continue;
    ++hits;
    EXPECT_FALSE(blocked(lambda)) << i;
    EXPECT_FALSE(blocked(0.5 * lambda)) << i;
    EXPECT_TRUE(blocked(std::nextafter(lambda, 1e300))) << i;
    EXPECT_TRUE(blocked(2.0 * lambda)) << i;
  }
  EXPECT_GT(hits, 30);
  for (const double end : {1.0, 5.0, std::numeric_limits<double>::infinity()}) {
    const std::uint64_t together = set.blocked(rays.sheet(), ~std::uint64_t{0}, end);
    for (std::size_t i = 0; i < sheet_size; ++i) {
      EXPECT_EQ((together >> i) & 1U, set.blocked(rays.from(i), rays.along(i), end) ? 1U : 0U)
          << i << " " << end;
    }
  }
}

TEST(Blocked, ByATorus) {
  expect_what_the_first_crossing_says(torus(1.0, 0.4));
}

TEST(Blocked, ByWhatIsAskedOneByOne) {
  expect_what_the_first_crossing_says(box(Vec3{1.5, 1.0, 2.0}));
}

TEST(Blocked, ByAPolynomialInEveryWay) {
  for (const RootFinder finder : {RootFinder::interval, RootFinder::affine, RootFinder::polynomial}) {
    SCOPED_TRACE(name(finder));
    expect_what_the_first_crossing_says(formula_shape(barth, finder));
    expect_what_the_first_crossing_says(formula_shape(twice, finder));
  }
}

TEST(Blocked, ByAFormulaInEveryWay) {
  for (const RootFinder finder : {RootFinder::interval, RootFinder::affine}) {
    SCOPED_TRACE(name(finder));
    expect_what_the_first_crossing_says(formula_shape(gyroid, finder));
  }
}

}  // namespace
}  // namespace backlight
