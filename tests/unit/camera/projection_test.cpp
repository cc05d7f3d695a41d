#include "backlight/camera/projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

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
                                         Projection::mercator, Projection::fisheye, Projection::cubemap));

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

// Six cameras of 90 degrees, to the bit: (2x/a - 1, 1 - 2y/a) on each face of a pixels.
TEST(Projection, ACubemapsFacesAreItsSixPerspectives) {
  Lens lens = lens_of(Projection::cubemap);
  const double edge = 30.0;
  struct Face {
    int column, row;
    Vec3 forward, right, up;
  };
  const Vec3 f = lens.forward, r = lens.right, u = lens.up;
  for (const Face& face : {Face{0, 0, r, -f, u}, Face{1, 0, -r, f, u}, Face{2, 0, u, r, -f},
                           Face{0, 1, -u, r, f}, Face{1, 1, f, r, u}, Face{2, 1, -f, -r, u}}) {
    for (int j = 0; j < 30; j += 7) {
      for (int i = 0; i < 30; i += 4) {
        const double x = 2.0 * (i + 0.5) / edge - 1.0;
        const double y = 1.0 - 2.0 * (j + 0.5) / edge;
        const Vec3 d = face.forward + x * face.right + y * face.up;
        const Vec3 expected = d * (1.0 / glm::length(d));
        const Vec3 found = *direction_at(lens, {face.column * edge + i + 0.5, face.row * edge + j + 0.5});
        EXPECT_EQ(found, expected) << face.column << face.row << ' ' << i << ' ' << j;
      }
    }
  }
}

TEST(Projection, EveryDirectionIsOnACubemap) {
  Lens lens = lens_of(Projection::cubemap);
  lens.width = 900;
  lens.height = 600;
  double sum = 0.0;
  for (int j = 0; j < 600; ++j) {
    for (int i = 0; i < 900; ++i) sum += pixel_solid_angle(lens, {i + 0.5, j + 0.5});
  }
  EXPECT_NEAR(sum, 4.0 * pi, 1e-4);
  for (double a = 0.1; a < 6.3; a += 0.3) {
    for (double b = -1.5; b < 1.6; b += 0.2) {
      const Vec3 d{std::cos(a) * std::cos(b), std::sin(b), std::sin(a) * std::cos(b)};
      const auto p = point_of(lens, d);
      ASSERT_TRUE(p);
      EXPECT_LT(glm::length(*direction_at(lens, *p) - d), 1e-14);
    }
  }
  // Corners and edges of the cube belong to a face, too.
  for (const Vec3& d :
       {lens.forward + lens.right, lens.up - lens.forward, lens.forward + lens.right + lens.up})
    EXPECT_TRUE(point_of(lens, glm::normalize(d)));
}

TEST(Projection, AScreenStraightAheadIsAPerspective) {
  Lens lens = lens_of(Projection::perspective);
  const Lens plain = lens;
  const ScreenFilm film = film_of(plain);
  lens.screen = film;
  for (const ImagePoint p : {ImagePoint{0.5, 0.5}, ImagePoint{33.5, 41.5}, ImagePoint{89.5, 12.5}}) {
    EXPECT_EQ(*direction_at(lens, p), *direction_at(plain, p));
    EXPECT_EQ(pixel_solid_angle(lens, p), pixel_solid_angle(plain, p));
  }
}

TEST(Projection, AScreenOffTheAxisIsLookedThrough) {
  Lens lens = lens_of(Projection::perspective);
  lens.screen = ScreenFilm{{130.0, -20.0}, 0.02, 0.05};
  for (const ImagePoint p : {ImagePoint{0.5, 0.5}, ImagePoint{33.5, 41.5}, ImagePoint{89.5, 12.5}}) {
    const Vec3 d = lens.forward + (p.x - 130.0) * 0.02 * lens.right + (-20.0 - p.y) * 0.05 * lens.up;
    EXPECT_EQ(*direction_at(lens, p), d * (1.0 / glm::length(d)));
    const auto again = point_of(lens, *direction_at(lens, p));
    ASSERT_TRUE(again);
    EXPECT_NEAR(again->x, p.x, 1e-11);
    EXPECT_NEAR(again->y, p.y, 1e-11);
  }
  EXPECT_EQ(straight_ahead(lens).x, 130.0);
}

TEST(Projection, NamesAreThoseOfTheSceneFormat) {
  for (const char* name : {"perspective", "equirectangular", "mercator", "fisheye", "cubemap"})
    EXPECT_EQ(name_of(*projection_named(name)), name);
  EXPECT_FALSE(projection_named("cube").has_value());
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

TEST(Sampling, AnyFirstPowerOfTwoIsOneInEachRectangle) {
  for (int pixel = 0; pixel < 5; ++pixel) {
    for (int k = 1; k <= 12; ++k) {
      for (int i = 0; i <= k; ++i) {  // 2^i columns, 2^(k - i) rows
        std::vector<int> cells(std::size_t{1} << unsigned(k), 0);
        for (int n = 0; n < 1 << k; ++n) {
          const ImagePoint p = sample_point({1, 1, pixel, 20}, n, 1 << k);
          ASSERT_GE(p.x, pixel);
          ASSERT_LT(p.x, pixel + 1);
          ASSERT_GE(p.y, 20.0);
          ASSERT_LT(p.y, 21.0);
          const int column = static_cast<int>(std::ldexp(p.x - pixel, i));
          const int row = static_cast<int>(std::ldexp(p.y - 20.0, k - i));
          ++cells[static_cast<std::size_t>((row << i) + column)];
        }
        ASSERT_TRUE(std::ranges::all_of(cells, [](int count) { return count == 1; })) << k << ' ' << i;
      }
    }
  }
}

// Over many pixels any sample, and what one coordinate says of the other or of the next sample, is as good as
// by chance: else some edges would be wrong in the same way everywhere.
TEST(Sampling, OverManyPixelsAnySampleIsAnywhere) {
  constexpr int edge = 8, pixels = 64 * 400;
  for (const int index : {0, 1, 2, 5, 16, 100}) {
    std::array<std::array<int, edge * edge>, 3> cells{};
    for (int i = 0; i < pixels; ++i) {
      const ImagePoint a = unit_sample({3, 1, i % 160, i / 160}, index);
      const ImagePoint b = unit_sample({3, 1, i % 160, i / 160 + 1}, index);
      const auto cell = [](double x, double y) {
        return static_cast<std::size_t>(static_cast<int>(x * edge) + edge * static_cast<int>(y * edge));
      };
      ++cells[0][cell(a.x, a.y)];
      ++cells[1][cell(a.x, b.x)];
      ++cells[2][cell(std::fmod(a.x * edge, 1.0), std::fmod(a.y * edge, 1.0))];
    }
    for (const auto& counts : cells) {
      double chi_squared = 0.0;
      for (const int count : counts) chi_squared += (count - 400.0) * (count - 400.0) / 400.0;
      EXPECT_LT(chi_squared, 120.0) << index;  // of 63 degrees of freedom: once in 50,000
      EXPECT_GT(chi_squared, 25.0) << index;
    }
  }
}

TEST(Sampling, PartsOfAPixelHaveTheirOwn) {
  const ImagePoint whole = unit_sample({1, 1, 10, 20}, 0);
  const ImagePoint part = unit_sample({1, 1, 10, 20, 1}, 0);
  EXPECT_NE(whole.x, part.x);
  EXPECT_NE(whole.y, part.y);
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
