#include "backlight/spacetime/extended.h"

#include <gtest/gtest.h>

#include <random>

namespace backlight {
namespace {

double difference(Extended a, Extended b) {
  return double(a - b);
}

TEST(Extended, SumKeepsWhatADoubleLoses) {
  const Extended sum = Extended(1e16) + Extended(1e-10);
  EXPECT_EQ(difference(sum, Extended(1e16)), 1e-10);
}

TEST(Extended, ProductAndQuotientUndoEachOther) {
  std::mt19937_64 rng(1);
  std::uniform_real_distribution<double> value(0.1, 10.0);
  for (int i = 0; i < 1000; ++i) {
    const Extended a = Extended(value(rng)) + Extended(value(rng) * 1e-17);
    const Extended b = Extended(value(rng)) + Extended(value(rng) * 1e-17);
    EXPECT_LT(std::abs(difference(a * b / b, a)), 1e-30 * a.hi);
  }
}

TEST(Extended, SquareRootSquaresBack) {
  std::mt19937_64 rng(2);
  std::uniform_real_distribution<double> value(1e-3, 1e3);
  for (int i = 0; i < 1000; ++i) {
    const Extended a = Extended(value(rng)) + Extended(value(rng) * 1e-17);
    const Extended root = sqrt(a);
    EXPECT_LT(std::abs(difference(root * root, a)), 1e-30 * a.hi);
  }
  EXPECT_EQ(sqrt(Extended(0.0)).hi, 0.0);
}

TEST(Extended, ExponentialsMatchSixtyDigits) {
  // mpmath, mp.dps = 60: the double nearest to the value, and what is left of it.
  EXPECT_LT(std::abs(difference(exp(Extended(1.0)), {2.718281828459045, 1.4456468917292502e-16})), 1e-30);
  EXPECT_LT(std::abs(difference(sinh(Extended(0.125)), {0.12532577524111546, -4.318309886229614e-18})),
            1e-32);
  EXPECT_LT(std::abs(difference(cosh(Extended(14.5)), {991379.6317690365, 3.2473059102196614e-11})), 1e-22);
}

TEST(Extended, CoshSquaredMinusSinhSquaredIsOne) {
  for (const double rapidity : {1e-3, 0.3, 0.6, 2.0, 14.0}) {
    const Extended s = sinh(rapidity);
    const Extended c = cosh(rapidity);
    EXPECT_LT(std::abs(difference(c * c - s * s, 1.0)), 1e-28 * (c * c).hi) << rapidity;
  }
}

}  // namespace
}  // namespace backlight
