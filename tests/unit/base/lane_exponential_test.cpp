#include "backlight/base/lane_exponential.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace backlight {
namespace {

double e_to(double x) {
  return exponential(Lanes<2>(x)).value().v[0];
}

// Long double has 64 bits: its own rounding is 2^-11 of the units counted here.
TEST(LaneExponential, IsWithinFourUnits) {
  double worst = 0.0, worst_complement = 0.0;
  for (double x = -707.9; x < 708.9; x += 0.0137) {
    const long double exact = std::exp(static_cast<long double>(x));
    const long double error = std::abs(static_cast<long double>(e_to(x)) - exact) / exact;
    worst = std::max(worst, static_cast<double>(error));
  }
  for (double x = -700.0; x < -1e-300; x *= 0.9937) {
    const long double exact = -std::expm1(static_cast<long double>(x));
    const double got = exponential(Lanes<2>(x)).complement().v[0];
    const long double error = std::abs(static_cast<long double>(got) - exact) / exact;
    worst_complement = std::max(worst_complement, static_cast<double>(error));
  }
  EXPECT_LT(worst, 4 * 0x1p-53);
  EXPECT_LT(worst_complement, 6 * 0x1p-53);
}

TEST(LaneExponential, Ends) {
  EXPECT_EQ(e_to(0.0), 1.0);
  EXPECT_EQ(e_to(-708.5), 0.0);
  EXPECT_EQ(e_to(-std::numeric_limits<double>::infinity()), 0.0);
  EXPECT_TRUE(std::isinf(e_to(709.5)));
  EXPECT_EQ(exponential(Lanes<2>(-800.0)).complement().v[0], 1.0);
}

}  // namespace
}  // namespace backlight
