#include "backlight/base/lane_arctangent.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace backlight {
namespace {

double angle(double y, double x) {
  return angle_of(Lanes<2>(y), Lanes<2>(x)).v[0];
}

TEST(LaneArctangent, IsRightToARounding) {
  double worst = 0.0;
  for (int turn = 0; turn < 200000; ++turn) {
    const double at = 0.7310585 * turn, size = std::exp(0.001 * (turn % 1000));
    const double x = size * std::cos(at), y = size * std::sin(at);
    const long double exact = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    worst = std::max(worst, static_cast<double>(std::abs(angle(y, x) - exact)));
    ASSERT_EQ(angle(y, x), angle_of(Lanes<1>(y), Lanes<1>(x)).v);
  }
  EXPECT_LT(worst, 5e-16);
}

TEST(LaneArctangent, AlongTheAxes) {
  constexpr double pi = std::numbers::pi;
  EXPECT_EQ(angle(0.0, 0.0), 0.0);
  EXPECT_EQ(angle(0.0, 2.0), 0.0);
  EXPECT_EQ(angle(3.0, 0.0), 0.5 * pi);
  EXPECT_EQ(angle(-3.0, 0.0), -0.5 * pi);
  EXPECT_EQ(angle(0.0, -1e-300), pi);
  EXPECT_EQ(angle(5.0, 5.0), 0.25 * pi);
  EXPECT_EQ(angle(-1e300, -1e300), -0.75 * pi);
}

}  // namespace
}  // namespace backlight
