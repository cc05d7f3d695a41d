#include "backlight/colour/stars.h"

#include <gtest/gtest.h>

namespace backlight {
namespace {

// T = 4600 (1 / (0.92 B-V + 1.7) + 1 / (0.92 B-V + 0.62)).
TEST(Stars, BallesterosFormula) {
  EXPECT_NEAR(temperature_from_bv(0.0), 10125.237191650855, 1e-10);
  EXPECT_NEAR(temperature_from_bv(0.65), 5778.423731066208, 1e-10);
}

// The Sun: B-V = 0.650 +- 0.01 (Gray 1992), effective temperature 5772 K (IAU 2015 resolution B3).
TEST(Stars, TheSun) {
  EXPECT_NEAR(temperature_from_bv(0.65), 5772.0, 50.0);
}

TEST(Stars, FallsFromBlueToRed) {
  for (int i = 0; i < 24; ++i) {
    EXPECT_GT(temperature_from_bv(-0.4 + 0.1 * i), temperature_from_bv(-0.4 + 0.1 * (i + 1))) << i;
  }
}

TEST(Stars, KeepsToTheRangeOfStars) {
  EXPECT_EQ(temperature_from_bv(-5.0), temperature_from_bv(-0.4));
  EXPECT_EQ(temperature_from_bv(9.0), temperature_from_bv(2.0));
}

}  // namespace
}  // namespace backlight
