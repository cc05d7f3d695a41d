// Every row of the table of operations, over intervals: bounds hold the values, and the flag tells where f is
// not continuous.
#include "backlight/expression/enclosure.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "backlight/expression/expression.h"
#include "continuity_cases.h"
#include "exact_operations.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using test::exact;
using test::nasty;
using test::tape_of;

class EveryOperation : public testing::TestWithParam<OperationInfo> {};

void check_point(Operation operation, double a, double b) {
  const std::vector<Interval> at{point(a), point(b)};
  const Interval found = enclose(tape_of(operation), at);
  const double low = exact(operation, a, b, MPFR_RNDD);
  const double high = exact(operation, a, b, MPFR_RNDU);
  const std::string where = " at " + std::to_string(a) + ", " + std::to_string(b);
  if (std::isnan(low)) {
    EXPECT_GE(found.continuity, Continuity::partial) << where;
    return;
  }
  if (found.continuity == Continuity::undefined) {
    // What only a limit makes a number is no number.
    EXPECT_TRUE(std::isinf(low) || b == 0.0) << where;
    return;
  }
  EXPECT_LE(found.lower, low == infinity ? std::numeric_limits<double>::max() : low) << where;
  EXPECT_GE(found.upper, high == -infinity ? -std::numeric_limits<double>::max() : high) << where;
  // The bounds of one point are tight: within a few rounding errors, or those of its operands' sizes for mod.
  const bool angle_too_large = std::abs(a) > 1e15;  // whole turns lie between two doubles
  if (std::isfinite(low) && std::isfinite(high) && !angle_too_large && operation != Operation::mod &&
      found.continuity == Continuity::continuous) {
    EXPECT_LE(found.upper - found.lower, (operation == Operation::integer_power ? 6e-15 : 4e-15) *
                                                 std::max(std::abs(low), std::abs(high)) +
                                             1e-307)
        << where;
  }
}

TEST_P(EveryOperation, HoldsTheExactValueAtPoints) {
  const OperationInfo& row = GetParam();
  const bool whole = row.operation == Operation::integer_power;
  for (const double a : nasty) {
    for (const double b : whole ? std::vector<double>{3.0, 4.0, 7.0, 12.0} : nasty) {
      if (row.operands == 1 && b != 0.0) continue;
      check_point(row.operation, a, b);
    }
  }
}

// Boxes between any two of the nasty numbers; points inside, and what the scalar evaluator says of them.
TEST_P(EveryOperation, HoldsTheScalarValuesInBoxes) {
  const OperationInfo& row = GetParam();
  const Tape tape = tape_of(row.operation);
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> any(0, nasty.size() - 1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<double> registers(2);
  for (int i = 0; i < 4000; ++i) {
    const auto [a_low, a_high] = std::minmax({nasty[any(random)], nasty[any(random)]});
    auto [b_low, b_high] = std::minmax({nasty[any(random)], nasty[any(random)]});
    if (row.operation == Operation::integer_power) b_low = b_high = 3.0 + i % 9;
    const std::vector<Interval> box{{a_low, a_high, Continuity::continuous},
                                    {b_low, b_high, Continuity::continuous}};
    const Interval found = enclose(tape, box);
    for (int k = 0; k < 6; ++k) {
      const double s = share(random), t = share(random);
      const double a = k == 0   ? a_low
                       : k == 1 ? a_high
                                : std::clamp(a_low * (1 - s) + a_high * s, a_low, a_high);
      const double b = k == 0   ? b_low
                       : k == 1 ? b_high
                                : std::clamp(b_low * (1 - t) + b_high * t, b_low, b_high);
      const double value = run<double>(tape, std::vector<double>{a, b}, registers);
      const std::string where = std::to_string(a) + ", " + std::to_string(b);
      if (std::isnan(value)) {
        EXPECT_GE(found.continuity, Continuity::partial) << where;
      } else if (std::isfinite(value) && found.continuity != Continuity::undefined) {
        EXPECT_LE(found.lower, value) << where;
        EXPECT_GE(found.upper, value) << where;
      } else if (std::isfinite(value)) {
        EXPECT_TRUE(b == 0.0 || a == 0.0) << where;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table, EveryOperation, testing::ValuesIn(operation_table));

Expression parsed(const std::string& text) {
  const auto result = Expression::parse(text, {"x"});
  if (const auto* error = std::get_if<ExpressionError>(&result))
    ADD_FAILURE() << text << ": " << error->message;
  return std::get<Expression>(result);
}

Interval over(const std::string& text, double low, double high) {
  return enclose(parsed(text).tape(), std::vector<Interval>{{low, high, Continuity::continuous}});
}

TEST(Enclosure, EvenPowersAreTight) {
  for (const char* text : {"x^2", "x^4", "x^6", "x^40"}) EXPECT_EQ(over(text, -1.0, 0.5).lower, 0.0) << text;
  EXPECT_EQ(over("x^3", -1.0, 2.0).lower, -1.0);
  EXPECT_EQ(over("x^3", -1.0, 2.0).upper, 8.0);
}

TEST(Enclosure, FlagsWhereThereIsNoContinuity) {
  for (const auto& [text, flag] : continuity_about_zero())
    EXPECT_EQ(over(text, -0.5, 0.5).continuity, flag) << text;
}

TEST(Enclosure, SlopesHoldTheDerivatives) {
  for (const char* text :
       {"sin(3*x)*x", "x^5 - 2*x", "exp(x)/(2 + x)", "sqrt(2 + x)", "atan(x)*tanh(x)", "cbrt(x + 2)",
        "abs(x)", "max(x, x^2)", "acos(x/2)", "pow(2 + x, x)", "cosh(x) + sinh(2*x)", "log(3 + x)"}) {
    const Expression f = parsed(text);
    const std::vector<double> origin{0.0}, direction{1.0};
    for (double low = -1.0; low < 0.95; low += 0.25) {
      const IntervalSlope found = enclose(f.tape(), VariableLine{origin, direction}, low, low + 0.3);
      for (int k = 0; k <= 10; ++k) {
        const Dual at = f.evaluate(std::vector<Dual>{{low + 0.03 * k, 1.0}});
        EXPECT_LE(found.slope.lower - 1e-14, at.derivative) << text << " at " << low;
        EXPECT_GE(found.slope.upper + 1e-14, at.derivative) << text << " at " << low;
        EXPECT_TRUE(found.value.lower <= at.value && at.value <= found.value.upper) << text << " at " << low;
      }
    }
  }
}

TEST(Enclosure, LeavesTheRoundingModeAsItWas) {
  const volatile double one = 1.0, three = 3.0;
  const double before = one / three;
  over("exp(x) + sin(x)", -1.0, 1.0);
  EXPECT_EQ(one / three, before);
  EXPECT_EQ(-(-one / three), before);
}

}  // namespace
}  // namespace backlight
