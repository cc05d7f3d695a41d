// Texture coordinates at points worked out by hand, and that no face shows its texture in a mirror.
#include <gtest/gtest.h>

#include <cmath>

#include "backlight/surface/surface_set.h"

namespace backlight {
namespace {

/// What a ray from `from` towards `to` resolves to on the shape.
SurfacePoint look(const Shape& shape, const Vec3& from, const Vec3& to,
                  const Placement& placement = Placement()) {
  SurfaceSet set;
  set.add(shape, placement);
  set.build();
  const Hit hit = set.nearest(from, to - from);
  EXPECT_TRUE(hit.found());
  return set.resolve(hit, from, to - from);
}

void expect_uv(const SurfacePoint& point, double u, double v) {
  EXPECT_NEAR(point.u, u, 1e-15);
  EXPECT_NEAR(point.v, v, 1e-15);
}

const Vec3 centre{0.0};

TEST(Texture, SphereIsAGlobe) {
  expect_uv(look(sphere(2), {0, 0, 9}, centre), 0.5, 0.5);
  expect_uv(look(sphere(2), {9, 0, 0}, centre), 0.75, 0.5);   // 90 degrees east
  expect_uv(look(sphere(2), {-9, 0, 0}, centre), 0.25, 0.5);  // 90 degrees west
  EXPECT_NEAR(look(sphere(2), {0, 9, 0}, centre).v, 0.0, 1e-15);
  EXPECT_NEAR(look(sphere(2), {0, -9, 0}, centre).v, 1.0, 1e-15);
  // 30 degrees east, 45 degrees north.
  const double side = std::sqrt(0.5);
  expect_uv(look(sphere(2), {9 * side * 0.5, 9 * side, 9 * side * std::sqrt(0.75)}, centre), 0.5 + 30.0 / 360,
            0.25);
}

TEST(Texture, BoxFacesSpanTheUnitSquare) {
  const Shape shape = box({2, 4, 6});
  expect_uv(look(shape, {0.5, 1, 9}, {0.5, 1, 0}), 0.75, 0.25);       // +z: right is +x
  expect_uv(look(shape, {0.5, 1, -9}, {0.5, 1, 0}), 0.25, 0.25);      // -z: right is -x
  expect_uv(look(shape, {9, 1, 1.5}, {0, 1, 1.5}), 0.25, 0.25);       // +x: right is -z
  expect_uv(look(shape, {-9, 1, 1.5}, {0, 1, 1.5}), 0.75, 0.25);      // -x: right is +z
  expect_uv(look(shape, {0.5, 9, 1.5}, {0.5, 0, 1.5}), 0.75, 0.75);   // +y: down is +z
  expect_uv(look(shape, {0.5, -9, 1.5}, {0.5, 0, 1.5}), 0.75, 0.25);  // -y: down is -z
}

TEST(Texture, CylinderAndCone) {
  expect_uv(look(cylinder(1, 4), {9, 1, 0}, {0, 1, 0}), 0.75, 0.25);
  expect_uv(look(cylinder(1, 4), {0.5, 9, 0.25}, {0.5, 0, 0.25}), 0.75, 0.625);
  expect_uv(look(cylinder(1, 4), {0.5, -9, 0.25}, {0.5, 0, 0.25}), 0.75, 0.375);
  expect_uv(look(cone(1, 0.5, 4), {0, -1, 9}, {0, -1, 0}), 0.5, 0.75);
  expect_uv(look(cone(1, 0.5, 4), {0.25, 9, 0}, {0.25, 0, 0}), 0.75, 0.5);
}

TEST(Texture, TorusDiskPlaneQuadric) {
  expect_uv(look(torus(2, 0.5), {9, 0, 0}, centre), 0.75, 0.5);
  expect_uv(look(torus(2, 0.5), {0, 9, 2}, {0, 0, 2}), 0.5, 0.25);
  expect_uv(look(torus(2, 0.5), {0, -9, 2}, {0, 0, 2}), 0.5, 0.75);
  expect_uv(look(disk(2), {1, 3, -0.5}, {1, 0, -0.5}), 0.75, 0.375);
  expect_uv(look(disk(2), {1, -3, -0.5}, {1, 0, -0.5}), 0.75, 0.375);
  expect_uv(look(plane(), {7.25, 3, -2.5}, {7.25, 0, -2.5}), 7.25, -2.5);
  expect_uv(look(quadric({0, 0, 0, 0, 0, 0, 0, 1, 0, 0}), {7.25, 3, -2.5}, {7.25, 0, -2.5}), 7.25, -2.5);
}

TEST(Texture, BelongsToTheObjectNotToTheFrame) {
  const Placement placed({10, 20, 30}, {0, 90, 0}, {3, 3, 3});  // local +z now points along rest +x
  expect_uv(look(sphere(2), {40, 20, 30}, {10, 20, 30}, placed), 0.5, 0.5);
}

TEST(Texture, FacesAreNotMirrored) {
  // For a viewer outside, u grows to the right and v downwards: (∂P/∂u × ∂P/∂v)·N < 0 at an ordinary point.
  const Vec3 eye{5, 6, 7};
  for (const Shape& shape :
       {sphere(1), box({1, 1, 1}), cylinder(1, 1), cone(1, 0, 2), torus(1, 0.4), disk(1)}) {
    const double step = 1e-4;
    const Vec3 target{0.3, 0.1, 0.75};
    const SurfacePoint here = look(shape, eye, target);
    const SurfacePoint one = look(shape, eye, target + Vec3{step, 0, 0});
    const SurfacePoint two = look(shape, eye, target + Vec3{0, step, 0});
    const double in_texture = (one.u - here.u) * (two.v - here.v) - (one.v - here.v) * (two.u - here.u);
    const double in_space =
        glm::dot(glm::cross(one.position - here.position, two.position - here.position), here.normal);
    EXPECT_LT(in_texture * in_space, 0.0) << static_cast<int>(shape.kind);
  }
}

}  // namespace
}  // namespace backlight
