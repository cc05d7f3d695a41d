#include "backlight/surface/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "backlight/surface/placement.h"
#include "backlight/surface/solid.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Shape, GoodSizesHaveNoProblem) {
  for (const Shape& shape : {sphere(1e-9), box({1, 2, 3}), cylinder(1, 2), cone(1, 0, 2), cone(0, 1, 2),
                             torus(2, 1), disk(1), plane(), quadric({1, 1, 1, 0, 0, 0, 0, 0, 0, -1})}) {
    EXPECT_EQ(problem(shape), "");
  }
}

TEST(Shape, RootFindersHaveNames) {
  EXPECT_EQ(root_finder(sphere(1)), RootFinder::closed_form);
  EXPECT_EQ(root_finder(cone(1, 0, 2)), RootFinder::closed_form);
  EXPECT_EQ(root_finder(torus(2, 1)), RootFinder::quartic);
  EXPECT_EQ(root_finder(csg({{}, {}, SolidOperation::unite, {{sphere(1), {}, {}, {}, 0}}, 0})),
            RootFinder::solid);
  EXPECT_EQ(name(RootFinder::closed_form), "closed form");
  EXPECT_EQ(name(RootFinder::quartic), "quartic");
  EXPECT_EQ(name(RootFinder::interval), "interval + derivative");
  EXPECT_EQ(name(RootFinder::polynomial), "polynomial");
  EXPECT_EQ(name(RootFinder::affine), "reduced affine");
  EXPECT_EQ(name(RootFinder::solid), "CSG");
}

TEST(Shape, BadSizesAreNamed) {
  for (const double bad : {0.0, -1.0, infinity, nan}) {
    EXPECT_EQ(problem(sphere(bad)), "radius must be positive and finite");
    EXPECT_EQ(problem(disk(bad)), "radius must be positive and finite");
    EXPECT_EQ(problem(box({1, bad, 1})), "size must be three positive finite numbers");
    EXPECT_EQ(problem(cylinder(bad, 1)), "radius must be positive and finite");
    EXPECT_EQ(problem(cylinder(1, bad)), "height must be positive and finite");
    EXPECT_EQ(problem(cone(1, 0, bad)), "height must be positive and finite");
    EXPECT_EQ(problem(torus(bad, 1)), "major must be positive and finite");
    EXPECT_EQ(problem(torus(1, bad)), "minor must be positive and finite");
  }
  EXPECT_EQ(problem(cone(-1, 0, 1)), "radius must be finite and not negative");
  EXPECT_EQ(problem(cone(1, nan, 1)), "top_radius must be finite and not negative");
  EXPECT_EQ(problem(cone(0, 0, 1)), "radius and top_radius must not both be zero");
  EXPECT_EQ(problem(torus(1, 1)), "minor must be less than major");
  EXPECT_EQ(problem(torus(1, 2)), "minor must be less than major");
  EXPECT_EQ(problem(quadric({0, 0, 0, 0, 0, 0, 0, 0, 0, 5})),
            "at least one of the first nine coefficients must not be zero");
  EXPECT_EQ(problem(quadric({1, 0, nan, 0, 0, 0, 0, 0, 0, 5})), "coefficients must be finite");
}

TEST(Shape, OnlyPlanesAndOpenQuadricsAreInfinite) {
  EXPECT_TRUE(is_infinite(plane()));
  EXPECT_TRUE(is_infinite(quadric({1, 1, -1, 0, 0, 0, 0, 0, 0, -1})));
  EXPECT_FALSE(is_infinite(quadric({1, 1, 1, 0, 0, 0, 0, 0, 0, -1})));
  EXPECT_FALSE(is_infinite(torus(2, 1)));
}

void expect_vector(const Vec3& value, const Vec3& wanted, double tolerance) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(value[i], wanted[i], tolerance) << "component " << i;
  }
}

TEST(Placement, TurnsAboutXThenYThenZ) {
  const Mat3 turn = Placement(Vec3{0.0}, {90, 90, 0}).rest_from_local();
  expect_vector(turn * Vec3{0, 1, 0}, {1, 0, 0}, 0.0);   // y -> z (about x) -> x (about y)
  expect_vector(turn * Vec3{1, 0, 0}, {0, 0, -1}, 0.0);  // x stays, then -> -z
  expect_vector(Placement(Vec3{0.0}, {0, 0, 90}).rest_from_local() * Vec3{1, 0, 0}, {0, 1, 0}, 0.0);
  expect_vector(Placement(Vec3{0.0}, {0, 30, 0}).rest_from_local() * Vec3{0, 0, 1}, {0.5, 0, std::sqrt(0.75)},
                2e-16);
}

TEST(Placement, QuarterTurnsAreExact) {
  for (int quarter = -9; quarter <= 9; ++quarter) {
    const Mat3 turn = Placement(Vec3{0.0}, {0, 0, 90.0 * quarter}).rest_from_local();
    EXPECT_EQ(turn[0].x, quarter % 2 != 0 ? 0.0 : (quarter % 4 == 0 ? 1.0 : -1.0)) << quarter;
    EXPECT_EQ(std::abs(turn[0].y), quarter % 2 != 0 ? 1.0 : 0.0) << quarter;
  }
}

TEST(Placement, InverseUndoesScaleAndTurn) {
  const Placement placement({1, 2, 3}, {10, -70, 200}, {2, -0.5, 1e3});
  const Mat3 product = placement.local_from_rest() * placement.rest_from_local();
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      const double size = std::abs(placement.scale()[column] / placement.scale()[row]);
      EXPECT_NEAR(product[column][row], column == row ? 1.0 : 0.0, 1e-15 * size);
    }
  }
}

TEST(Placement, BadNumbersAreNamed) {
  EXPECT_EQ(problem(Placement({1, 2, 3}, {4, 5, 6}, {1, -1, 2})), "");
  EXPECT_EQ(problem(Placement({nan, 0, 0})), "position must be finite");
  EXPECT_EQ(problem(Placement(Vec3{0.0}, {0, infinity, 0})), "rotate must be finite");
  EXPECT_EQ(problem(Placement(Vec3{0.0}, Vec3{0.0}, {1, 0, 1})), "scale must be finite and not zero");
}

}  // namespace
}  // namespace backlight
