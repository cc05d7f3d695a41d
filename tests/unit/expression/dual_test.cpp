#include "backlight/expression/dual.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "backlight/expression/expression.h"

namespace backlight {
namespace {

Expression parsed(const std::string& text) {
  const auto result = Expression::parse(text, {"x"});
  if (const auto* error = std::get_if<ExpressionError>(&result))
    ADD_FAILURE() << text << ": " << error->message;
  return std::get<Expression>(result);
}

Dual derivative(const std::string& text, double x) {
  return parsed(text).evaluate(std::vector<Dual>{{x, 1.0}});
}

struct Rule {
  std::string function;
  std::string derivative;
};

class DerivativeRules : public testing::TestWithParam<Rule> {};

// Every row of the table of operations against the rule of the calculus books, itself an expression.
TEST_P(DerivativeRules, AreThoseOfTheBooks) {
  const Expression rule = parsed(GetParam().derivative);
  const Expression function = parsed(GetParam().function);
  for (const double x : {0.125, 0.3, 0.6, 0.9375}) {
    const double expected = rule.evaluate(std::vector<double>{x});
    const Dual found = function.evaluate(std::vector<Dual>{{x, 1.0}});
    EXPECT_EQ(found.value, function.evaluate(std::vector<double>{x})) << GetParam().function << " at " << x;
    EXPECT_NEAR(found.derivative, expected, 1e-14 * (1.0 + std::abs(expected)))
        << GetParam().function << " at " << x;
    const Dual twice = function.evaluate(std::vector<Dual>{{x, 2.0}});
    EXPECT_NEAR(twice.derivative, 2.0 * expected, 2e-14 * (1.0 + std::abs(expected))) << GetParam().function;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, DerivativeRules,
    testing::Values(Rule{"x + 2*x", "3"}, Rule{"4 - x", "-1"}, Rule{"x*sin(x)", "sin(x) + x*cos(x)"},
                    Rule{"1/x", "-1/x^2"}, Rule{"x/(1 + x)", "1/(1 + x)^2"}, Rule{"-x", "-1"},
                    Rule{"x^2", "2*x"}, Rule{"x^5", "5*x^4"}, Rule{"x^-3", "-3*x^-4"},
                    Rule{"sin(2*x)", "2*cos(2*x)"}, Rule{"cos(2*x)", "-2*sin(2*x)"},
                    Rule{"tan(x)", "1/cos(x)^2"}, Rule{"asin(x)", "1/sqrt(1 - x^2)"},
                    Rule{"acos(x)", "-1/sqrt(1 - x^2)"}, Rule{"atan(3*x)", "3/(1 + 9*x^2)"},
                    Rule{"atan2(x, 2)", "2/(x^2 + 4)"}, Rule{"atan2(2, x)", "-2/(x^2 + 4)"},
                    Rule{"sinh(x)", "cosh(x)"}, Rule{"cosh(x)", "sinh(x)"}, Rule{"tanh(x)", "1/cosh(x)^2"},
                    Rule{"exp(3*x)", "3*exp(3*x)"}, Rule{"log(5*x)", "1/x"}, Rule{"sqrt(x)", "0.5*x^-0.5"},
                    Rule{"cbrt(x)", "x^(-2/3)/3"}, Rule{"abs(-2*x)", "2"}, Rule{"abs(2*x)", "2"},
                    Rule{"floor(3*x)", "0"}, Rule{"min(x, x^2)", "2*x"}, Rule{"max(x, x^2)", "1"},
                    Rule{"x^1.5", "1.5*sqrt(x)"}, Rule{"2^x", "log(2)*2^x"}, Rule{"x^x", "x^x*(1 + log(x))"},
                    Rule{"mod(5*x, 0.7)", "5"}, Rule{"mod(7, x)", "-floor(7/x)"},
                    Rule{"clamp(x, -1, 2)", "1"}, Rule{"clamp(x, 2, 3)", "0"}));

TEST(Dual, ConstantExponentsHaveNoDerivativeOfTheirOwn) {
  EXPECT_EQ(derivative("x^35", -1.0).derivative, 35.0);  // d/db would be v log(-1)
  EXPECT_EQ(derivative("abs(x)", 0.0).derivative, 0.0);
  EXPECT_TRUE(std::isinf(derivative("sqrt(x)", 0.0).derivative));
  EXPECT_TRUE(std::isnan(derivative("sqrt(x)", -1.0).value));
}

}  // namespace
}  // namespace backlight
