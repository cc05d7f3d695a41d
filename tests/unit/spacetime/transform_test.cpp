#include "backlight/spacetime/transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace backlight {
namespace {

ExtendedVec3 celerity_of(double u, const Vec3& axis) {
  const ExtendedVec3 a{axis};
  return (Extended(u) / sqrt(dot(a, a))) * a;
}

// The null vector boosted in double-double, as the reference: n' = (γt - u·x; x + ((u·x)/(γ+1) - t) u).
ExtendedEvent reference(const ExtendedVec3& to, const ExtendedVec3& from, const Vec3& x) {
  const ExtendedVec3 wide{x};
  const ExtendedEvent n{-sqrt(dot(wide, wide)), wide};
  return boost(to, boost(Extended(-1.0) * from, n));
}

double relative_error(const NullDirection<Rest>& n, const ExtendedEvent& exact) {
  const ExtendedVec3 difference = ExtendedVec3{n.x} - exact.x;
  const double length = double(sqrt(dot(exact.x, exact.x)));
  const double direction = double(sqrt(dot(difference, difference))) / length;
  const double doppler = std::abs(double(Extended(n.length) + exact.t)) / length;
  return std::max(direction, doppler);
}

Vec3 random_unit(std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  return glm::normalize(Vec3{normal(rng), normal(rng), normal(rng)});
}

class NullBoost : public testing::TestWithParam<double> {};

// docs/physics.md equation (14): D and direction to a few ulp at any γ, from anywhere on the sky down to rays
// within 1/γ of the axis; below robust_gamma the standard form, whose loss is γ² ulps.
TEST_P(NullBoost, IsExactToAFewUlpAtAnySpeed) {
  const double gamma = GetParam();
  const double u = std::sqrt((gamma - 1.0) * (gamma + 1.0));
  std::mt19937_64 rng(7);
  std::uniform_real_distribution<double> angle(0.0, 2.0 / gamma);
  double worst = 0.0;
  const Vec3 axes[] = {{0.0, 0.0, 1.0}, Vec3{3.0, 4.0, 12.0} / 13.0, {0.48, -0.6, 0.64}};
  for (int i = 0; i < 6000; ++i) {
    // The celerity is a double, so that only the boost's own errors are seen; oblique ones need the fused
    // products.
    const Vec3 axis = axes[i % 3];
    const ExtendedVec3 to{u * axis};
    Vec3 d = random_unit(rng);
    if (i % 2 == 0) {
      const double a = angle(rng);
      d = glm::normalize(std::sin(a) * d - std::cos(a) * axis);
    }
    const auto transform = relative_transform<Rest, Camera>(to, ExtendedVec3{});
    const NullDirection<Rest> n = transform(null_direction<Camera>(d));
    const double error = relative_error(n, reference(to, ExtendedVec3{}, d));
    ASSERT_FALSE(std::isnan(error));
    worst = std::max(worst, error);
  }
  // The plain form sums γ and three products of its size to D = 1/2γ or so: seven roundings, each of half an
  // ulp of γ at most, are 7γ² ulps of D at the very worst, and 4γ² in practice.
  const double ulp = 2.220446049250313e-16;
  EXPECT_LT(worst, gamma > robust_gamma ? 9.0 * ulp : (3.0 + 4.0 * gamma * gamma) * ulp)
      << "at gamma " << gamma;
}

INSTANTIATE_TEST_SUITE_P(FromRestToTheExtreme, NullBoost,
                         testing::Values(1.0001, 1.5, 10.0, 29.0, 31.0, 1e3, 1e6, 1e8));

TEST(RelativeTransform, ComposesFramesOfLargeGammaWithoutLosingTheirRelativeMotion) {
  std::mt19937_64 rng(11);
  for (const double u : {0.5, 10.0, 1e3, 1e6}) {
    for (int i = 0; i < 200; ++i) {
      const ExtendedVec3 from = celerity_of(u, random_unit(rng));
      // A frame at celerity 1.5 as seen from `from`, composed at 32 digits.
      const InertialFrame outer{from, {}};
      const InertialFrame inner{celerity_of(1.5, random_unit(rng)), {}};
      const InertialFrame to = within(outer, inner);
      const auto transform = relative_transform<Rest, Camera>(to.celerity, from);
      EXPECT_NEAR(transform.gamma(), std::sqrt(1.0 + 1.5 * 1.5), 1e-14);
      const Vec3 d = random_unit(rng);
      EXPECT_LT(relative_error(transform(null_direction<Camera>(d)), reference(to.celerity, from, d)), 1e-14);
    }
  }
}

TEST(RelativeTransform, OfEqualFramesChangesNoBit) {
  const ExtendedVec3 u = celerity_of(1e6, {1.0, 2.0, -0.3});
  const auto transform = relative_transform<Rest, Camera>(u, u);
  const Vec3 d{0.1, 0.2, 0.7};
  EXPECT_TRUE(transform.is_identity());
  EXPECT_EQ(transform(null_direction<Camera>(d)).x, d);
}

TEST(RelativeTransform, OfAMovingFrameToItselfThroughDifferentBitsIsStillARotationFreeUnit) {
  const ExtendedVec3 u = celerity_of(3.0, {1.0, 2.0, -0.3});
  ExtendedVec3 nearly = u;
  nearly[0] = nearly[0] + Extended(1e-30);
  const auto transform = relative_transform<Rest, Camera>(nearly, u);
  EXPECT_NEAR(transform.rotation()[0][0], 1.0, 1e-15);
  EXPECT_NEAR(transform.rotation()[1][0], 0.0, 1e-15);
}

TEST(RelativeTransform, KeepsTheIntervalOfAnyDisplacement) {
  std::mt19937_64 rng(3);
  for (int i = 0; i < 500; ++i) {
    const auto transform = relative_transform<Rest, Camera>(celerity_of(2.0, random_unit(rng)),
                                                            celerity_of(5.0, random_unit(rng)));
    const Displacement<Camera> d{1.3, 2.0 * random_unit(rng)};
    EXPECT_NEAR(interval(transform(d)), interval(d), 1e-12 * transform.gamma() * transform.gamma());
  }
}

TEST(RelativeTransform, RotationIsWigners) {
  // Two perpendicular boosts of equal celerity u: the axes turn by θ with tan(θ/2) = (u/(γ+1))² (Ungar 1991).
  const double u = 2.0;
  const double gamma = std::sqrt(1.0 + u * u);
  const auto t = relative_transform<Rest, Camera>(celerity_of(u, {0, 1, 0}), celerity_of(u, {1, 0, 0}));
  const double k = u / (gamma + 1.0);
  const double angle = 2.0 * std::atan(k * k);
  EXPECT_NEAR(t.rotation()[0][0], std::cos(angle), 1e-15);
  EXPECT_NEAR(std::abs(t.rotation()[0][1]), std::sin(angle), 1e-15);
  EXPECT_NEAR(t.rotation()[2][2], 1.0, 1e-15);
}

TEST(InertialFrame, ToWorldUndoesToFrame) {
  const InertialFrame frame{celerity_of(1e6, {1, 1, 0}), {Extended(1e9), ExtendedVec3{Vec3{3.0, -1e6, 2.0}}}};
  const ExtendedEvent event{Extended(1e9 + 0.25), ExtendedVec3{Vec3{1.0, 2.0, 3.0}}};
  const ExtendedEvent there_and_back = to_world(frame, to_frame(frame, event));
  EXPECT_NEAR(double(there_and_back.t - event.t), 0.0, 1e-10);
  EXPECT_NEAR(double(there_and_back.x[0] - event.x[0]), 0.0, 1e-10);
}

TEST(InertialFrame, OriginIsAtRestAtItsOwnCoordinates) {
  const InertialFrame frame{celerity_of(0.75, {1, 0, 0}), {Extended(2.0), ExtendedVec3{Vec3{5.0, 0.0, 0.0}}}};
  // One second of its own time later it has moved by the celerity.
  const ExtendedEvent later = to_world(frame, {Extended(1.0), {}});
  EXPECT_DOUBLE_EQ(double(later.x[0]), 5.75);
  EXPECT_DOUBLE_EQ(double(later.t), 2.0 + 1.25);
}

TEST(Aberration, FollowsTheSeedPapersEquationOne) {
  // tan(β/2) = √((1-v)/(1+v)) tan(α/2), α the angle from the direction of motion at which the object's frame
  // (here: the sky) sees what the camera, moving through it, sees at β.
  const double v = 0.99;
  const double u = v / std::sqrt((1 - v) * (1 + v));
  const auto sky_from_camera = relative_transform<Rest, Camera>(ExtendedVec3{}, celerity_of(u, {0, 0, 1}));
  for (double beta = 0.05; beta < 3.1; beta += 0.1) {
    const auto n = sky_from_camera(null_direction<Camera>({std::sin(beta), 0.0, std::cos(beta)}));
    const double alpha = std::atan2(n.x.x, n.x.z);
    EXPECT_NEAR(std::tan(beta / 2), std::sqrt((1 - v) / (1 + v)) * std::tan(alpha / 2),
                1e-12 * std::tan(beta / 2));
  }
}

}  // namespace
}  // namespace backlight
