#include "backlight/camera/projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "backlight/camera/sampling.h"

namespace backlight {
namespace {

constexpr double pi = std::numbers::pi;

Lens lens_of(Projection projection) {
  Lens lens;
  lens.projection = projection;
  lens.width = 90;
  lens.height = 60;
  lens.fov = projection == Projection::fisheye ? pi : 1.2;
  EXPECT_TRUE(aim(lens, {0.3, -0.2, 1.0}, {0.0, 1.0, 0.1}));
  return lens;
}

class EveryProjection : public testing::TestWithParam<Projection> {};

TEST_P(EveryProjection, PointUndoesDirection) {
  const Lens lens = lens_of(GetParam());
  int seen = 0;
  for (double y = 0.25; y < lens.height; y += 3.7) {
    for (double x = 0.25; x < lens.width; x += 4.3) {
      const auto d = direction_at(lens, {x, y});
      if (!d) continue;
      ++seen;
      EXPECT_NEAR(glm::length(*d), 1.0, 1e-15);
      const auto p = point_of(lens, *d);
      ASSERT_TRUE(p.has_value()) << x << ' ' << y;
      EXPECT_NEAR(p->x, x, 1e-10);
      EXPECT_NEAR(p->y, y, 1e-10);
    }
  }
  EXPECT_GT(seen, 100);
}

TEST_P(EveryProjection, SolidAngleIsTheJacobianOfTheDirection) {
  const Lens lens = lens_of(GetParam());
  const double h = 1e-4;
  for (const ImagePoint p : {ImagePoint{45.5, 30.5}, ImagePoint{60.5, 12.5}, ImagePoint{25.5, 40.5}}) {
    const Vec3 dx = *direction_at(lens, {p.x + h, p.y}) - *direction_at(lens, {p.x - h, p.y});
    const Vec3 dy = *direction_at(lens, {p.x, p.y + h}) - *direction_at(lens, {p.x, p.y - h});
    const double area = glm::length(glm::cross(dx, dy)) / (4.0 * h * h);
    EXPECT_NEAR(pixel_solid_angle(lens, p), area, 1e-6 * area);
  }
}

INSTANTIATE_TEST_SUITE_P(Projections, EveryProjection,
                         testing::Values(Projection::perspective, Projection::equirectangular,
                                         Projection::mercator, Projection::fisheye));

TEST(Projection, PerspectiveFollowsTheSceneFormat) {
  Lens lens;
  lens.width = 4;
  lens.height = 2;
  lens.fov = pi / 2;
  ASSERT_TRUE(aim(lens, {0, 0, 1}, {0, 1, 0}));
  // Pixel (3, 0): x = (2·3.5/4 - 1) tan 45° = 0.75, y = (1 - 2·0.5/2)·(2/4) = 0.25; right = forward × up =
  // -x.
  const Vec3 d = *direction_at(lens, {3.5, 0.5});
  const double norm = std::sqrt(1.0 + 0.75 * 0.75 + 0.25 * 0.25);
  EXPECT_DOUBLE_EQ(d.x, -0.75 / norm);
  EXPECT_DOUBLE_EQ(d.y, 0.25 / norm);
  EXPECT_DOUBLE_EQ(d.z, 1.0 / norm);
}

TEST(Projection, EquirectangularCentreIsForwardAndTopIsUp) {
  const Lens lens = lens_of(Projection::equirectangular);
  const Vec3 centre = *direction_at(lens, {45.0, 30.0});
  const Vec3 top = *direction_at(lens, {45.0, 0.0});
  EXPECT_LT(glm::length(centre - lens.forward), 1e-15);
  EXPECT_LT(glm::length(top - lens.up), 1e-15);
}

TEST(Projection, FisheyeShowsNothingOutsideItsCircle) {
  const Lens lens = lens_of(Projection::fisheye);
  EXPECT_FALSE(direction_at(lens, {0.5, 0.5}).has_value());
  EXPECT_NEAR(glm::dot(*direction_at(lens, {90.0, 30.0}), lens.forward), std::cos(lens.fov / 2), 1e-15);
}

TEST(Projection, PolesAndSeamOfAPanoramaAreOnTheFilm) {
  Lens lens;
  lens.projection = Projection::equirectangular;
  lens.width = 64;
  lens.height = 48;
  ASSERT_TRUE(aim(lens, {0, 0, 1}, {0, 1, 0}));
  for (const Vec3 d :
       {Vec3{0, -1, 0}, Vec3{0, 1, 0}, Vec3{0, 0, -1}, Vec3{-1e-17, 0, -1}, Vec3{1e-17, 0, -1}}) {
    const auto p = point_of(lens, d);
    ASSERT_TRUE(p) << d.x << ' ' << d.y << ' ' << d.z;
    EXPECT_LT(p->x, 64.0);
    EXPECT_LT(p->y, 48.0);
  }
}

TEST(Projection, AimRefusesParallelUpAndNoDirection) {
  Lens lens;
  EXPECT_FALSE(aim(lens, {0, 2, 0}, {0, 1, 0}));
  EXPECT_FALSE(aim(lens, {0, 0, 0}, {0, 1, 0}));
}

TEST(Sampling, OneSampleIsThePixelCentre) {
  const ImagePoint p = sample_point({5, 1, 17, 3}, 0, 1);
  EXPECT_EQ(p.x, 17.5);
  EXPECT_EQ(p.y, 3.5);
}

TEST(Sampling, PointsFillThePixelEvenly) {
  // A low-discrepancy set of 256: each of 64 equal cells gets between 2 and 6 points.
  int cells[8][8] = {};
  for (int i = 0; i < 256; ++i) {
    const ImagePoint p = sample_point({1, 1, 10, 20}, i, 256);
    ASSERT_GE(p.x, 10.0);
    ASSERT_LT(p.x, 11.0);
    ASSERT_GE(p.y, 20.0);
    ASSERT_LT(p.y, 21.0);
    ++cells[static_cast<int>((p.x - 10.0) * 8)][static_cast<int>((p.y - 20.0) * 8)];
  }
  for (const auto& row : cells) {
    for (const int count : row) {
      EXPECT_GE(count, 2);
      EXPECT_LE(count, 6);
    }
  }
}

TEST(Sampling, NeighbouringPixelsAndSeedsDiffer) {
  const ImagePoint a = sample_point({1, 1, 10, 20}, 0, 4);
  const ImagePoint b = sample_point({1, 1, 11, 20}, 0, 4);
  const ImagePoint c = sample_point({2, 1, 10, 20}, 0, 4);
  EXPECT_NE(a.x + 1.0, b.x);
  EXPECT_NE(a.x, c.x);
}

}  // namespace
}  // namespace backlight
