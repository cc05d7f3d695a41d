#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "backlight/spacetime/transform.h"

namespace backlight {
namespace {

TEST(ExtendedTransform, IsOneBoostAfterTheOther) {
  const ExtendedVec3 from{Vec3{3e5, -1e5, 2e5}};
  const ExtendedVec3 to{Vec3{-1e4, 7e5, 0.5}};
  const ExtendedEvent d{Extended(-1.0), ExtendedVec3{Vec3{0.6, 0.0, 0.8}}};
  const ExtendedEvent expected = boost(to, boost(Extended(-1.0) * from, d));
  const ExtendedEvent result = ExtendedTransform(to, from)(d);
  EXPECT_LT(std::abs(double(result.t - expected.t)), 1e-18 * std::abs(expected.t.hi));
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(std::abs(double(result.x[i] - expected.x[i])), 1e-18 * std::abs(expected.t.hi)) << i;
  }
}

TEST(ExtendedTransform, KeepsNullVectorsNullAtLargeGamma) {
  const ExtendedTransform transform(ExtendedVec3{Vec3{1e6, 2e5, -3e5}}, ExtendedVec3{});
  const ExtendedVec3 looking{Vec3{0.36, -0.48, 0.8}};
  const ExtendedEvent n = transform({-sqrt(dot(looking, looking)), looking});
  EXPECT_LT(std::abs(double(dot(n.x, n.x) - n.t * n.t)), 1e-14);
}

struct Composition {
  double to[3], from[3], looking[3];
  double celerity[3];
  double rotation[9];  // by rows
  double seen[8];      // t, x, y, z as sums of two
};

constexpr Composition compositions[] = {
#include "composition_cases.inc"
};

Vec3 vec(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}

// docs/physics.md equation (1a): nothing is lost at any relative γ, along, across or against each other.
TEST(RelativeMotion, IsWhatMatricesOf120DigitsGive) {
  double most_gamma = 0.0;
  for (const Composition& c : compositions) {
    const RelativeMotion motion = relative_motion(ExtendedVec3{vec(c.to)}, ExtendedVec3{vec(c.from)});
    most_gamma = std::max(most_gamma, motion.gamma);
    EXPECT_LT(glm::length(motion.celerity - vec(c.celerity)), 3e-16 * motion.speed) << motion.gamma;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        EXPECT_NEAR(motion.rotation[column][row], c.rotation[3 * row + column], 3e-16) << motion.gamma;
      }
    }
  }
  EXPECT_GT(most_gamma, 2e12);
}

TEST(ExtendedTransform, IsWhatMatricesOf120DigitsGive) {
  for (const Composition& c : compositions) {
    const ExtendedVec3 to{vec(c.to)}, from{vec(c.from)};
    const ExtendedEvent n = ExtendedTransform(to, from)({Extended(-1.0), ExtendedVec3{vec(c.looking)}});
    const double room = 2e-31 * double(lorentz_factor(to) * lorentz_factor(from));
    EXPECT_LT(std::abs(double(n.t - Extended(c.seen[0], c.seen[1]))), room);
    for (int i = 0; i < 3; ++i) {
      EXPECT_LT(std::abs(double(n.x[i] - Extended(c.seen[2 + 2 * i], c.seen[3 + 2 * i]))), room) << i;
    }
  }
}

}  // namespace
}  // namespace backlight
