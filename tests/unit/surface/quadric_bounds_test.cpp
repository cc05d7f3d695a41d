// Quadrics that are ellipsoids have bounds, which hold, and none else has.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "backlight/surface/solid.h"
#include "backlight/surface/surface_set.h"

namespace backlight {
namespace {

using Coefficients = std::array<double, 10>;

// (x - c)·A(x - c) = k, times a factor of any sign, with A = R diag(1/r²) Rᵀ.
struct Ellipsoid {
  Mat3 axes{1.0};  // columns
  Vec3 radii{1.0};
  Vec3 centre{0.0};
  double factor = 1.0;

  [[nodiscard]] Coefficients coefficients() const {
    Mat3 a{0.0};
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) a[j][i] += factor * axes[k][i] * axes[k][j] / (radii[k] * radii[k]);
    }
    const Vec3 ac = a * centre;
    return {a[0][0],       a[1][1],     a[2][2],     2.0 * a[1][0], 2.0 * a[2][0],
            2.0 * a[2][1], -2.0 * ac.x, -2.0 * ac.y, -2.0 * ac.z,   glm::dot(centre, ac) - factor};
  }
};

BoundingSphere bounds_of(const Coefficients& coefficients, const Placement& placement = {}) {
  SurfaceSet set;
  set.add(quadric(coefficients), placement);
  set.build();
  return set.bounds(0);
}

TEST(QuadricBounds, EncloseEllipsoidsOfAnyOrientation) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-0.7, 0.7);
  for (int i = 0; i < 300; ++i) {
    Ellipsoid e;
    const Vec3 a = glm::normalize(Vec3{normal(random), normal(random), normal(random)});
    const Vec3 b = glm::normalize(glm::cross(a, Vec3{normal(random), normal(random), normal(random)}));
    e.axes = Mat3{a, b, glm::cross(a, b)};
    for (int k = 0; k < 3; ++k) e.radii[k] = std::pow(10.0, exponent(random));
    if (i % 3 != 0) e.centre = std::pow(10.0, exponent(random)) * Vec3{normal(random), normal(random), 1.0};
    e.factor = (i % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, 6.0 * exponent(random));
    const Placement placement(Vec3{3.0, -2.0, 5.0}, Vec3{20.0, 30.0, -50.0},
                              i % 5 == 0 ? Vec3{1.0, 2.5, 0.3} : Vec3{1.0});
    const BoundingSphere bounds = bounds_of(e.coefficients(), placement);
    ASSERT_TRUE(std::isfinite(bounds.radius)) << i;
    double farthest = 0.0;
    for (int n = 0; n < 2000; ++n) {
      const Vec3 on = glm::normalize(Vec3{normal(random), normal(random), normal(random)});
      const Vec3 local = e.centre + e.axes * (e.radii * on);
      farthest = std::max(farthest, glm::length(placement.rest_from_local() * local));
    }
    EXPECT_GE(bounds.radius, farthest * (1.0 - 1e-12)) << i;
    EXPECT_LE(bounds.radius, 3.0 * farthest) << i;
  }
}

TEST(QuadricBounds, AreThoseOfTheBallForASphere) {
  for (const double unit : {1e-8, 1.0, 1e8}) {
    const double c = 1.0 / (unit * unit);
    EXPECT_NEAR(bounds_of({c, c, c, 0, 0, 0, 0, 0, 0, -1}).radius / unit, 1.0, 1e-10);
  }
  EXPECT_NEAR(bounds_of({1, 0.25, 4, 0, 0, 0, 0, 0, 0, -1}).radius, 2.0, 1e-10);
}

TEST(QuadricBounds, OfNothingAreFinite) {
  EXPECT_TRUE(std::isfinite(bounds_of({1, 1, 1, 0, 0, 0, 0, 0, 0, 1}).radius));
}

TEST(QuadricBounds, AreClaimedOfNothingElse) {
  const Coefficients open[] = {{1, 1, 0, 0, 0, 0, 0, 0, 0, -1},           // a cylinder
                               {1, -1, 1, 0, 0, 0, 0, 0, 0, -1},          // a hyperboloid
                               {1, 0, 1, 0, 0, 0, 0, -1, 0, 0},           // a paraboloid
                               {1, 1, -1, 0, 0, 0, 0, 0, 0, 0},           // a cone
                               {0, 0, 0, 0, 0, 0, 0, 1, 0, 0},            // a plane
                               {1, 1, 1, 2, 0, 0, 0, 0, 0, -1},           // an oblique cylinder
                               {1, 1, 1, 3, 0, 0, 0, 0, 0, -1},           // an oblique hyperboloid
                               {1, 1, 1, 2, 2, 2, 0, 0, 0, -1},           // two planes
                               {1, 1, 1, -1.2, -1.2, -1.2, 0, 0, 0, -1},  // of two sheets
                               {1, 1, 1e-300, 0, 0, 1e-140, 0, 0, 0, -1}};
  for (const Coefficients& coefficients : open) EXPECT_TRUE(std::isinf(bounds_of(coefficients).radius));
}

// Found by the search of what has bounds, as they were among what has none.
TEST(QuadricBounds, LoseNoHit) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  SurfaceSet set;
  for (int i = 0; i < 40; ++i) {
    const double x = 0.7 * (i % 7) - 2.0, y = 0.8 * (i / 7) - 2.0;
    const Shape shape = quadric({3.0, 5.0, 4.0, 1.0, -0.5, 0.7, 0.1 * i, 0.2, -0.3, -1.0});
    const Placement placement(Vec3{x, y, 0.1 * i}, Vec3{10.0 * i, 5.0, 0.0}, Vec3{1.0, 0.7, 1.2});
    set.add(shape, placement);
  }
  set.build();
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 from{10.0 * normal(random), 10.0 * normal(random), 10.0 * normal(random)};
    const Vec3 way = Vec3{normal(random), normal(random), normal(random)} - from;
    Hit nearest;
    for (int s = 0; s < 40; ++s) {
      const Hit hit = set.first_crossing_of(s, from, way);
      if (hit.lambda < nearest.lambda) nearest = hit;
    }
    hits += nearest.found() ? 1 : 0;
    for (const Search search : {Search::tree, Search::every_surface}) {
      const Hit hit = set.nearest(from, way, std::numeric_limits<double>::infinity(), {}, search);
      EXPECT_EQ(hit.surface, nearest.surface);
      EXPECT_EQ(hit.lambda, nearest.lambda);
    }
  }
  EXPECT_GT(hits, 500);
}

// A box without a ball, of which the ball is a part that is solid outside: what is kept is the box's.
TEST(QuadricBounds, OfASolidThatIsAllTheRestAreNone) {
  const double corner = 2.0;
  for (const double sign : {1.0, -1.0}) {
    const SolidTree block{box(Vec3{2.0 * corner}), {}, SolidOperation::unite, {}, 0};
    const Shape ball = quadric({sign, sign, sign, 0, 0, 0, 0, 0, 0, -sign});
    const SolidTree part{ball, {}, SolidOperation::unite, {}, 1};
    SurfaceSet set;
    set.add(csg(SolidTree{{}, {}, SolidOperation::intersect, {block, part}, 0}), Placement{});
    set.build();
    const Hit hit = set.nearest(Vec3{0.3, 0.2, -9.0}, Vec3{0.0, 0.0, 1.0});
    ASSERT_TRUE(hit.found());
    EXPECT_NEAR(hit.lambda, sign < 0.0 ? 9.0 - corner : 9.0 - std::sqrt(1.0 - 0.13), 1e-12);
    EXPECT_NEAR(set.bounds(0).radius, (sign < 0.0 ? corner : 1.0) * std::sqrt(3.0), 1e-9);
  }
}

}  // namespace
}  // namespace backlight
