// Sums of waves: what they are recognised in, and that they are the formulas.
#include "backlight/expression/waves.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace backlight {
namespace {

Expression formula(const std::string& text) {
  auto parsed = Expression::parse(text, {"x", "t"});
  if (const auto* wrong = std::get_if<ExpressionError>(&parsed)) {
    ADD_FAILURE() << wrong->message;
    return {};
  }
  return std::get<Expression>(std::move(parsed));
}

class WaveSums : public testing::TestWithParam<const char*> {};

TEST_P(WaveSums, AreTheFormulas) {
  const Expression f = formula(GetParam());
  const auto sum = wave_sum(f, 1);
  ASSERT_TRUE(sum.has_value());
  for (const double t : {-3e6, -77.3, -1.0, 0.0, 0.3, 12.0, 4567.8}) {
    double value = sum->constant + sum->slope * t;
    for (const WaveSum::Wave& wave : sum->waves) {
      EXPECT_GT(wave.rate, 0.0);
      value += wave.cosine * std::cos(wave.rate * t) + wave.sine * std::sin(wave.rate * t);
    }
    EXPECT_NEAR(value, f.evaluate(std::array{9.0, t}), sum->doubt(std::abs(t))) << t;
  }
  EXPECT_LT(sum->doubt(1.0), 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Formulas, WaveSums,
                         testing::Values("3", "t", "-t/8 + 2", "cos(t)", "2*sin(-3*t + 1) - 4",
                                         "1 + 0.5*(cos(2*t) - sin(t*2)/3 + 0.1*t)", "cos(1)*t - sin(0*t + 2)",
                                         "-(sin(t) + sin(t) - (3 - t)*0.25)*sqrt(2)"));

TEST(WaveSum, HasAWaveOfARateOnce) {
  const auto sum = wave_sum(formula("cos(2*t) + 3*sin(2*t) - cos(t*2)"), 1);
  ASSERT_TRUE(sum.has_value());
  ASSERT_EQ(sum->waves.size(), 1U);
  EXPECT_EQ(sum->waves[0].cosine, 0.0);
  EXPECT_EQ(sum->waves[0].sine, 3.0);
}

TEST(WaveSum, DoubtsWhatCancels) {
  const auto sum = wave_sum(formula("cos(t + 1e9) + (t + 1e9) - 1e9"), 1);
  ASSERT_TRUE(sum.has_value());
  EXPECT_GT(sum->doubt(0.0), 1e-7);
}

TEST(WaveSum, IsNotOfOtherFormulas) {
  for (const char* text :
       {"t^2", "sin(t)*cos(t)", "sin(sin(t))", "x + t", "max(t, 0)", "1/t", "exp(t)", "t/0"})
    EXPECT_FALSE(wave_sum(formula(text), 1).has_value()) << text;
}

std::optional<double> period(const std::string& one, const std::string& other = "0") {
  return period_of_rates(std::array{formula(one), formula(other)}, 1);
}

TEST(PeriodOfRates, IsThatOfAllWaves) {
  constexpr double turn = 6.283185307179586;
  EXPECT_DOUBLE_EQ(period("x*cos(2*t) - x^2*sin(2*t + 1)").value(), turn / 2.0);
  EXPECT_DOUBLE_EQ(period("0.5*t + cos(t)*(3 + x)", "sin(t/3)").value(), 3.0 * turn);
  EXPECT_DOUBLE_EQ(period("x/(2 + cos(0.9*t))", "sqrt(3 + sin(0.6*t)) - 2*t").value(), 2.0 * turn / 0.6);
  EXPECT_DOUBLE_EQ(period("x*t + sin(sin(-4*t))").value(), turn / 4.0);
}

TEST(PeriodOfRates, IsNotKnownOfOthers) {
  for (const char* text : {"t", "x", "t*cos(t)", "t^2", "cos(t) + cos(sqrt(2)*t)", "cos(x*t)", "sqrt(t)",
                           "cos(t^2)", "x/t", "cos(t) + cos(1.0001*t)"})
    EXPECT_FALSE(period(text).has_value()) << text;
}

}  // namespace
}  // namespace backlight
