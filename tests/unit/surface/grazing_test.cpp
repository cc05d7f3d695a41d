// The tangency ladder: rays that miss or cut a surface by 2^-1 ... 2^-52 of its size, from near and from 2^30
// sizes away. All coordinates are exact doubles, so hit or miss is beyond doubt, and the chord has a closed
// form.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "backlight/surface/surface_set.h"

namespace backlight {
namespace {

/// How far a computed chord may be off: as far as moving the ray by two roundings would move it.
constexpr double shift = 4.5e-16;

SurfaceSet only(const Shape& shape) {
  SurfaceSet set;
  set.add(shape, Placement());
  set.build();
  return set;
}

/// Shoots along `along` at every depth of the ladder, from `start(depth)` pushed back, and compares half the
/// chord with `half_chord(depth)`, where depth > 0 cuts and depth < 0 misses. The chord's middle is at λ ·
/// length = distance.
void climb(const Shape& shape, const Vec3& along, const std::function<Vec3(double)>& start,
           const std::function<double(double)>& half_chord) {
  const SurfaceSet set = only(shape);
  for (const double distance : {4.0, 1048576.0, 1073741824.0}) {
    for (const double length : {1.0, 0x1p-20, 0x1p+20}) {
      for (int k = 2; k <= 51; ++k) {
        const double depth = std::ldexp(1.0, -k);
        SCOPED_TRACE("distance " + std::to_string(distance) + ", depth 2^-" + std::to_string(k));
        const Vec3 back = distance * along;
        EXPECT_FALSE(set.nearest(start(-depth) - back, length * along).found());
        const Hit hit = set.nearest(start(depth) - back, length * along);
        ASSERT_TRUE(hit.found());
        const Vec3 point = set.resolve(hit, start(depth) - back, length * along).position;
        const double chord = -glm::dot(point, along);  // the middle of the chord is at the foot of the origin
        EXPECT_GE(chord, half_chord(depth - shift) - shift);
        EXPECT_LE(chord, half_chord(depth + shift) + shift);
        EXPECT_NEAR(hit.lambda * length, distance - half_chord(depth),
                    half_chord(depth + shift) - half_chord(depth - shift) + shift + 2.3e-16 * distance);
      }
    }
  }
}

/// √(r² - (r - depth)²), zero where there is no chord.
double of_circle(double radius, double depth) {
  return std::sqrt(std::max(depth * (2.0 * radius - depth), 0.0));
}

TEST(Grazing, Sphere) {
  climb(
      sphere(1), {0, 0, 1},
      [](double depth) {
        return Vec3{1.0 - depth, 0, 0};
      },
      [](double depth) { return of_circle(1.0, depth); });
}

TEST(Grazing, Cylinder) {
  climb(
      cylinder(1, 8), {0, 0, 1},
      [](double depth) {
        return Vec3{1.0 - depth, 0.5, 0};
      },
      [](double depth) { return of_circle(1.0, depth); });
}

TEST(Grazing, BoxEdgeIsSharp) {
  const SurfaceSet set = only(box({2, 2, 2}));
  for (const double distance : {4.0, 1048576.0, 1073741824.0}) {
    for (int k = 1; k <= 52; ++k) {
      const double depth = std::ldexp(1.0, -k);
      EXPECT_TRUE(set.nearest({1.0 - depth, 0, -distance}, {0, 0, 3}).found());
      EXPECT_FALSE(set.nearest({1.0 + depth, 0, -distance}, {0, 0, 3}).found());
    }
  }
}

TEST(Grazing, TorusOuterEquator) {
  // In the plane y = 0 the torus is the circle of radius major + minor.
  climb(
      torus(0.75, 0.25), {0, 0, 1},
      [](double depth) {
        return Vec3{1.0 - depth, 0, 0};
      },
      [](double depth) { return of_circle(1.0, depth); });
}

TEST(Grazing, TorusAlongTheTopOfItsTube) {
  // Contact of the fourth order: above x = major the tube turns away as z²/2R. With h = √(r² - y²), the
  // surface is left where ρ = R + h, z² = h (2R + h).
  const double major = 1.5;
  const double minor = 0.5;
  climb(
      torus(major, minor), {0, 0, 1},
      [=](double depth) {
        return Vec3{major, minor - depth, 0};
      },
      [=](double depth) {
        const double h = of_circle(minor, depth);
        return std::sqrt(h * (2.0 * major + h));
      });
}

TEST(Grazing, TorusTouchedExactlyEndsWithAnAnswer) {
  const SurfaceSet set = only(torus(1.5, 0.5));
  for (const double distance : {4.0, 1e9}) {
    const Hit hit = set.nearest({1.5, 0.5, -distance}, {0, 0, 1});
    if (hit.found()) {  // a touch may count or not; if it counts it is at the place of contact
      EXPECT_NEAR(hit.lambda, distance, 1e-3);
    }
  }
  // Along the axis of symmetry through the hole, and down onto the ridge of the tube.
  EXPECT_FALSE(set.nearest({0, 9, 0}, {0, -1, 0}).found());
  EXPECT_EQ(set.nearest({1.5, 9, 0}, {0, -1, 0}).lambda, 8.5);
}

TEST(Grazing, ThinTorusIsNotLost) {
  // Rays across the ring in its own plane and a little above it: four crossings or none, at known places.
  for (const double minor : {1e-1, 1e-3, 1e-6, 1e-9}) {
    const SurfaceSet set = only(torus(1, minor));
    for (const double part : {0.0, 0.5, 0.999, -0.999}) {
      const double y = part * minor;
      const Hit hit = set.nearest({-1e3, y, 0}, {1, 0, 0});
      ASSERT_TRUE(hit.found()) << minor << " " << part;
      const Vec3 point = set.resolve(hit, {-1e3, y, 0}, {1, 0, 0}).position;
      EXPECT_NEAR(point.x, -1.0 - of_circle(minor, minor - std::abs(y)), 1e-15);
    }
    EXPECT_FALSE(set.nearest({-1e3, 1.0001 * minor, 0}, {1, 0, 0}).found());
  }
}

}  // namespace
}  // namespace backlight
