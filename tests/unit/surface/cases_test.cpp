// Every closed form against 80-digit answers: tests/oracle/surface_cases.py makes the cases and says what
// their tolerances mean (the exact answer for a surface displaced by a few 1e-15 of its size).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "backlight/surface/surface_set.h"

namespace backlight {
namespace {

/// A constant vector: the tables are data, not code that runs at the start.
struct Constant3 {
  double x = 0.0, y = 0.0, z = 0.0;
  operator Vec3() const { return {x, y, z}; }
};

struct Case {
  ShapeKind kind;
  double values[10];
  Constant3 position, rotate, scale;
  Constant3 origin, direction;
  bool hit;
  double lambda = 0.0;
  int part = 0;  // -1: on an edge, either face will do
  Constant3 point{};
  Constant3 normal{};
  double cosine = 0.0;  // of the angle of incidence
  double lambda_tolerance = 0.0, point_tolerance = 0.0, normal_tolerance = 0.0;
};

// clang-format off
constexpr Case sphere_cases[] = {
#include "cases_sphere.inc"
};
constexpr Case box_cases[] = {
#include "cases_box.inc"
};
constexpr Case cylinder_cases[] = {
#include "cases_cylinder.inc"
};
constexpr Case cone_cases[] = {
#include "cases_cone.inc"
};
constexpr Case torus_cases[] = {
#include "cases_torus.inc"
};
constexpr Case disk_cases[] = {
#include "cases_disk.inc"
};
constexpr Case plane_cases[] = {
#include "cases_plane.inc"
};
constexpr Case quadric_cases[] = {
#include "cases_quadric.inc"
};
// clang-format on

/// Size of what the ray meets, in the rest frame.
double size_of(const SurfaceSet& set, const Case& c) {
  const double radius = set.bounds(0).radius;
  return std::isfinite(radius) ? radius : std::max(1.0, glm::length(Vec3(c.point) - Vec3(c.position)));
}

void check(const Case& c, Search search) {
  Shape shape{c.kind, {}};
  std::copy(std::begin(c.values), std::end(c.values), shape.values.begin());
  SurfaceSet set;
  set.add(shape, Placement(c.position, c.rotate, c.scale));
  set.build();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto blocked = [&](double end) { return set.blocked(c.origin, c.direction, end, {}, search); };
  const Hit hit = set.nearest(c.origin, c.direction, infinity, {}, search);
  ASSERT_EQ(hit.found(), c.hit);
  EXPECT_EQ(blocked(infinity), c.hit);
  if (!c.hit) {
    return;
  }
  EXPECT_NEAR(hit.lambda, c.lambda, c.lambda_tolerance);
  EXPECT_FALSE(blocked(hit.lambda));  // an open interval
  EXPECT_TRUE(blocked(std::nextafter(hit.lambda, 1e300)));

  const SurfacePoint point = set.resolve(hit, c.origin, c.direction);
  EXPECT_LE(glm::length(point.position - Vec3(c.point)), c.point_tolerance);
  if (c.part >= 0) {
    EXPECT_EQ(hit.part, c.part);
    EXPECT_LE(glm::length(point.normal - Vec3(c.normal)), c.normal_tolerance);
  }
  // The plain promise, where the ray does not graze: 1e-12 from within 1e3 sizes, 1e-6 sizes from 1e7.
  const double size = size_of(set, c);
  const double length = glm::length(Vec3(c.direction));
  const double distance = glm::length(Vec3(c.origin) - Vec3(c.position));
  if (c.cosine > 0.05 && c.part >= 0) {
    const double wanted = distance <= 1e3 * size * 1.01 ? 1e-12 : 1e-6;
    EXPECT_LE(std::abs(hit.lambda - c.lambda) * length, wanted * std::max(c.lambda * length, size));
    EXPECT_LE(glm::length(point.position - Vec3(c.point)), wanted * (size + glm::length(Vec3(c.position))));
  }
}

template <std::size_t count>
void check_all(const Case (&cases)[count], std::size_t at_least) {
  EXPECT_GE(count, at_least);  // the table is not an empty file
  std::size_t hits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    SCOPED_TRACE("case " + std::to_string(i) + ", line " + std::to_string(i + 2));
    check(cases[i], Search::every_surface);
    check(cases[i], Search::tree);
    hits += cases[i].hit ? 1 : 0;
  }
  EXPECT_GE(hits, count / 5);
  EXPECT_LT(hits, count);
}

TEST(SurfaceCases, Sphere) {
  check_all(sphere_cases, 400);
}
TEST(SurfaceCases, Box) {
  check_all(box_cases, 300);
}
TEST(SurfaceCases, Cylinder) {
  check_all(cylinder_cases, 350);
}
TEST(SurfaceCases, Cone) {
  check_all(cone_cases, 350);
}
TEST(SurfaceCases, Torus) {
  check_all(torus_cases, 450);
}
TEST(SurfaceCases, Disk) {
  check_all(disk_cases, 150);
}
TEST(SurfaceCases, Plane) {
  check_all(plane_cases, 150);
}
TEST(SurfaceCases, Quadric) {
  check_all(quadric_cases, 400);
}

}  // namespace
}  // namespace backlight
