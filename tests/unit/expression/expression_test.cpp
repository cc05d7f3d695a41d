#include "backlight/expression/expression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace backlight {
namespace {

const std::vector<std::string> variables{"t", "frame", "speed"};
const std::vector<double> values{0.75, 12.0, 4.5};

Expression parsed(const std::string& text) {
  auto result = Expression::parse(text, variables);
  if (const auto* error = std::get_if<ExpressionError>(&result))
    ADD_FAILURE() << text << ": " << error->message;
  return std::get<Expression>(result);
}

double value_of(const std::string& text) {
  return parsed(text).evaluate(values);
}

// The value of a text whose value is NaN or not, compared to the bit.
void expect_same(const std::string& text, double expected) {
  const double found = value_of(text);
  if (std::isnan(expected)) {
    EXPECT_TRUE(std::isnan(found)) << text << " = " << found;
  } else {
    EXPECT_EQ(found, expected) << text;
    EXPECT_EQ(std::signbit(found), std::signbit(expected)) << text;
  }
}

TEST(Expression, ReadsNumbers) {
  expect_same("0", 0.0);
  expect_same("42", 42.0);
  expect_same("  1.5\t", 1.5);
  expect_same(".25", 0.25);
  expect_same("3.", 3.0);
  expect_same("6.02e23", 6.02e23);
  expect_same("1E-3", 1e-3);
  expect_same("1e+2", 100.0);
  expect_same("0.1", 0.1);
  expect_same("pi", std::numbers::pi);
  expect_same("e", std::numbers::e);
  expect_same("2e0*e", 2.0 * std::numbers::e);
}

TEST(Expression, FollowsThePrecedenceOfMathematics) {
  expect_same("1 + 2 * 3", 7.0);
  expect_same("(1 + 2) * 3", 9.0);
  expect_same("7 - 4 - 2", 1.0);
  expect_same("16 / 4 / 2", 2.0);
  expect_same("2 * 3 ^ 2", 18.0);
  expect_same("-2^2", -4.0);
  expect_same("(-2)^2", 4.0);
  expect_same("2^3^2", 512.0);
  expect_same("2^-1", 0.5);
  expect_same("2^-t*4", std::pow(2.0, -0.75) * 4.0);
  expect_same("4 - -3", 7.0);
  expect_same("4 - +3", 1.0);
  expect_same("--5", 5.0);
  expect_same("+-+5", -5.0);
  expect_same("2*-3", -6.0);
  expect_same("-t^2", -(0.75 * 0.75));
}

TEST(Expression, LooksUpVariablesInTheOrderGiven) {
  expect_same("t", 0.75);
  expect_same("frame", 12.0);
  expect_same("speed*t - frame", 4.5 * 0.75 - 12.0);
}

TEST(Expression, AgreesWithTheLibraryToTheBit) {
  using Function = double (*)(double);
  const std::vector<std::pair<std::string, Function>> functions{
      {"sin", std::sin},   {"cos", std::cos},     {"tan", std::tan},   {"asin", std::asin},
      {"acos", std::acos}, {"atan", std::atan},   {"sinh", std::sinh}, {"cosh", std::cosh},
      {"tanh", std::tanh}, {"exp", std::exp},     {"log", std::log},   {"sqrt", std::sqrt},
      {"cbrt", std::cbrt}, {"floor", std::floor}, {"abs", std::abs}};
  for (const auto& [name, function] : functions) {
    const Expression expression = parsed(name + "(t)");
    for (const double x : {-7.25, -1.0, -0.3, -0.0, 0.0, 1e-9, 0.4, 0.99, 1.0, 2.5, 40.0}) {
      const double expected = function(x);
      const double found = expression.evaluate(std::vector<double>{x, 0.0, 0.0});
      if (std::isnan(expected)) {
        EXPECT_TRUE(std::isnan(found)) << name << "(" << x << ")";
      } else {
        EXPECT_EQ(found, expected) << name << "(" << x << ")";
      }
    }
  }
}

TEST(Expression, AgreesWithTheLibraryForTwoArguments) {
  expect_same("atan2(t, -speed)", std::atan2(0.75, -4.5));
  expect_same("atan2(-1, -2)", std::atan2(-1.0, -2.0));
  expect_same("pow(speed, t)", std::pow(4.5, 0.75));
  expect_same("speed^t", std::pow(4.5, 0.75));
  expect_same("frame^frame", std::pow(12.0, 12.0));
}

TEST(Expression, TakesTheSmallestAndLargestOfAnyNumber) {
  expect_same("min(3, t)", 0.75);
  expect_same("max(3, t)", 3.0);
  expect_same("min(5, 4, 3, 2, t, 9)", 0.75);
  expect_same("max(5, 4, frame, 2, t, 9)", 12.0);
  expect_same("clamp(t, 1, 2)", 1.0);
  expect_same("clamp(frame, 1, 2)", 2.0);
  expect_same("clamp(speed, 1, 5)", 4.5);
}

TEST(Expression, RemainderHasTheSignOfTheDivisor) {
  expect_same("mod(7, 3)", 1.0);
  expect_same("mod(-1, 3)", 2.0);
  expect_same("mod(1, -3)", -2.0);
  expect_same("mod(frame, speed)", 12.0 - 4.5 * std::floor(12.0 / 4.5));
}

TEST(Expression, WholePowersAreMultiplied) {
  const double x = 1.1;
  const auto power = [x](const std::string& exponent) {
    return parsed("t^" + exponent).evaluate(std::vector<double>{x, 0.0, 0.0});
  };
  EXPECT_EQ(power("0"), 1.0);
  EXPECT_EQ(power("1"), x);
  EXPECT_EQ(power("2"), x * x);
  EXPECT_EQ(power("3"), (x * x) * x);
  EXPECT_EQ(power("4"), (x * x) * (x * x));
  EXPECT_EQ(power("5"), ((x * x) * (x * x)) * x);
  EXPECT_EQ(power("(-2)"), 1.0 / (x * x));
  EXPECT_EQ(power("33"), std::pow(x, 33.0));
  EXPECT_EQ(power("2.5"), std::pow(x, 2.5));
  expect_same("(-3)^3", -27.0);
  expect_same("pow(-3, 3)", -27.0);
}

// (n - 1) roundings at most, each of half an ulp; pow itself is good to one.
TEST(Expression, WholePowersAreAccurate) {
  for (int n = 2; n <= 32; ++n) {
    const Expression power = parsed("t^" + std::to_string(n));
    for (const double x : {0.3, 0.77777, 1.1, -1.9, 2.7}) {
      const double expected = std::pow(x, n);
      const double found = power.evaluate(std::vector<double>{x, 0.0, 0.0});
      EXPECT_NEAR(found, expected, n * std::numeric_limits<double>::epsilon() * std::abs(expected))
          << x << "^" << n;
    }
  }
}

TEST(Expression, OutsideTheDomainIsNaN) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const char* text : {"sqrt(-1)", "sqrt(-t)", "log(-t)", "asin(frame)", "acos(-frame)", "(-t)^t",
                           "mod(t, 0)", "t-t + (1/0)*0", "min(sqrt(-t), 1)", "min(1, sqrt(-t))",
                           "max(sqrt(-t), 1)", "max(1, sqrt(-t))", "clamp(sqrt(-t), 0, 1)"}) {
    expect_same(text, nan);
  }
  expect_same("1/0", std::numeric_limits<double>::infinity());
  expect_same("-1/(t-t)", -std::numeric_limits<double>::infinity());
  expect_same("log(0)", -std::numeric_limits<double>::infinity());
  expect_same("exp(1000)", std::numeric_limits<double>::infinity());
}

TEST(Expression, KnowsWhatItDependsOn) {
  const Expression constant = parsed("2*pi + min(1, 2)");
  ASSERT_TRUE(constant.constant().has_value());
  EXPECT_EQ(*constant.constant(), 2.0 * std::numbers::pi + 1.0);
  EXPECT_FALSE(constant.uses(0));

  const Expression moving = parsed("speed * t");
  EXPECT_FALSE(moving.constant().has_value());
  EXPECT_TRUE(moving.uses(0));
  EXPECT_FALSE(moving.uses(1));
  EXPECT_TRUE(moving.uses(2));
  EXPECT_FALSE(moving.uses(99));
  EXPECT_EQ(moving.text(), "speed * t");
}

TEST(Expression, CopiesShareOneTape) {
  const Expression original = parsed("t + 1");
  const Expression copy = original;  // NOLINT: the copy is the point
  EXPECT_EQ(&copy.tape(), &original.tape());
  EXPECT_EQ(copy.evaluate(values), 1.75);
}

TEST(Expression, IsZeroByDefault) {
  EXPECT_EQ(Expression().constant(), 0.0);
  EXPECT_EQ(Expression().evaluate(std::vector<double>{}), 0.0);
  EXPECT_EQ(Expression().text(), "0");
}

TEST(Expression, RefusesTooFewValues) {
  EXPECT_THROW((void)parsed("t").evaluate(std::vector<double>{1.0}), std::invalid_argument);
}

TEST(Expression, ReservesTheNamesOfTheLanguage) {
  for (const char* name : {"pi", "e", "sin", "atan2", "min", "max", "mod", "clamp", "pow"}) {
    EXPECT_TRUE(is_expression_name(name)) << name;
  }
  for (const char* name : {"", "t", "frame", "x", "add", "square", "Sin"})
    EXPECT_FALSE(is_expression_name(name)) << name;
}

}  // namespace
}  // namespace backlight
