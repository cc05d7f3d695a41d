#include <gtest/gtest.h>

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

}  // namespace
}  // namespace backlight
