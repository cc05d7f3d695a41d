#include "backlight/expression/tape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "backlight/expression/expression.h"

namespace backlight {
namespace {

Expression parsed(const std::string& text) {
  auto result = Expression::parse(text, {"x", "y"});
  if (const auto* error = std::get_if<ExpressionError>(&result))
    ADD_FAILURE() << text << ": " << error->message;
  return std::get<Expression>(result);
}

TEST(Tape, EqualSubexpressionsAreComputedOnce) {
  // x, y, x+y, square, sin, times
  EXPECT_EQ(parsed("sin(x + y) * (y + x)^2").tape().instructions.size(), 6U);
}

TEST(Tape, ConstantPartsAreFolded) {
  EXPECT_EQ(parsed("x * (2*pi/360)").tape().instructions.size(), 3U);
  EXPECT_EQ(parsed("max(1, 2, sin(3))").tape().instructions.size(), 1U);
}

TEST(Tape, UnneededPartsAreLeftOut) {
  const Tape tape = parsed("sin(y)^0 * x").tape();
  EXPECT_TRUE(std::none_of(tape.instructions.begin(), tape.instructions.end(),
                           [](const Instruction& step) { return step.operation == Operation::sin; }));
}

TEST(Tape, RegistersAreUsedAgain) {
  std::string text = "x";
  for (int i = 2; i < 1000; ++i) text += " + sin(x*" + std::to_string(i) + ")";
  EXPECT_LE(parsed(text).tape().registers, 6U);
}

// sin(x+1), ..., sin(x+100), all of them alive until the product of pairs (i, 101-i) is formed.
TEST(Tape, MoreRegistersThanTheStackBufferGiveTheSameValue) {
  const int count = 100;
  std::string sum;
  std::string products;
  double expected = 0.0;
  double expected_products = 0.0;
  const double x = 0.3;
  for (int i = 1; i <= count; ++i) {
    const std::string term = "sin(x + " + std::to_string(i) + ")";
    const double value = std::sin(x + i);
    sum += (i > 1 ? " + " : "") + term;
    expected = i > 1 ? expected + value : value;
    products += " + " + term + "*sin(x + " + std::to_string(count + 1 - i) + ")";
    expected_products += value * std::sin(x + (count + 1 - i));
  }
  const Expression expression = parsed("(" + sum + ")*y + (0" + products + ")");
  ASSERT_GT(expression.tape().registers, 64U);
  EXPECT_EQ(expression.evaluate(std::vector<double>{x, 2.0}), expected * 2.0 + expected_products);
}

// A number type of another library: the tape of one expression serves it through the same run().
struct Interval {
  double low;
  double high;
  explicit Interval(double value = 0.0) : low(value), high(value) {}
  Interval(double l, double h) : low(l), high(h) {}
};
Interval operator+(Interval a, Interval b) {
  return {a.low + b.low, a.high + b.high};
}
Interval square(Interval a) {
  const double least = a.low > 0 ? a.low : a.high < 0 ? a.high : 0.0;
  return {least * least, std::max(a.low * a.low, a.high * a.high)};
}

}  // namespace

// Only what this test's expressions use; the others are never run.
template <>
Interval apply<Interval>(Operation operation, const Interval& a, const Interval& b) {
  if (operation == Operation::add) return a + b;
  EXPECT_EQ(operation, Operation::square);
  return square(a);
}

namespace {

TEST(Tape, RunsOnOtherNumberTypes) {
  const Expression expression = parsed("x^2 + y");
  std::vector<Interval> registers(expression.tape().registers);
  const std::vector<Interval> box{{-1.0, 2.0}, {10.0, 11.0}};
  const Interval range = run<Interval>(expression.tape(), box, registers);
  EXPECT_EQ(range.low, 10.0);
  EXPECT_EQ(range.high, 15.0);
}

}  // namespace
}  // namespace backlight
