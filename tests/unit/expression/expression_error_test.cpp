// What is said about texts that are not expressions, word for word.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "backlight/expression/expression.h"

namespace backlight {
namespace {

struct BadText {
  std::string text;
  int column;
  int length;
  std::string message;
  std::string hint;
};

class ExpressionErrors : public testing::TestWithParam<BadText> {};

TEST_P(ExpressionErrors, PointAtTheCharacter) {
  const BadText& bad = GetParam();
  const auto result = Expression::parse(bad.text, {"t", "frame", "speed"});
  const auto* error = std::get_if<ExpressionError>(&result);
  ASSERT_NE(error, nullptr) << bad.text;
  EXPECT_EQ(error->column, bad.column) << bad.text;
  EXPECT_EQ(error->length, bad.length) << bad.text;
  EXPECT_EQ(error->message, bad.message) << bad.text;
  EXPECT_EQ(error->hint, bad.hint) << bad.text;
}

INSTANTIATE_TEST_SUITE_P(
    Texts, ExpressionErrors,
    testing::Values(BadText{"", 1, 1, "the expression is empty", ""},  //
                    BadText{"   ", 4, 1, "the expression is empty", ""},
                    BadText{"2 +", 4, 1, "a value is missing at the end", ""},
                    BadText{"2 + * 3", 5, 1, "expected a value, found '*'", ""},
                    BadText{"2 ** 3", 4, 1, "unexpected '*'", "a power is written ^"},
                    BadText{"2 3", 3, 1, "an operator is missing before '3'", "write 2*3 to multiply"},
                    BadText{"2t", 2, 1, "an operator is missing before 't'", "write 2*t to multiply"},
                    BadText{"2e", 2, 1, "an operator is missing before 'e'", "write 2*e to multiply"},
                    BadText{"t(2)", 2, 1, "an operator is missing before '('", "write t*(...) to multiply"},
                    BadText{"(t)(2)", 4, 1, "an operator is missing before '('", "write * to multiply"},
                    BadText{"1.2.3", 4, 2, "an operator is missing before '.3'", "write 1.2*.3 to multiply"},
                    BadText{"(1 + 2", 1, 1, "'(' is not closed", ""},
                    BadText{"3 * sin(t", 8, 1, "'(' is not closed", ""},
                    BadText{"1 + 2)", 6, 1, "')' without a '('", ""},
                    BadText{"()", 2, 1, "expected a value, found ')'", ""},
                    BadText{"(1,5)", 3, 1, "unexpected ','", "a decimal point is written ."},
                    BadText{"1,5", 2, 1, "unexpected ','", ""},
                    BadText{"sin t", 1, 3, "'sin' is a function", "write sin(...)"},
                    BadText{"sin", 1, 3, "'sin' is a function", "write sin(...)"},
                    BadText{"1 + sine(t)", 5, 4, "unknown function 'sine'", "did you mean 'sin'?"},
                    BadText{"2*sped", 3, 4, "unknown name 'sped'", "did you mean 'speed'?"},
                    BadText{"Frame", 1, 5, "unknown name 'Frame'", "did you mean 'frame'?"},
                    BadText{"velocity_of_light", 1, 17, "unknown name 'velocity_of_light'", ""},
                    BadText{"sin()", 1, 3, "'sin' takes 1 argument, not 0", ""},
                    BadText{"sin(1, 2)", 1, 3, "'sin' takes 1 argument, not 2", ""},
                    BadText{"1 + atan2(1)", 5, 5, "'atan2' takes 2 arguments, not 1", ""},
                    BadText{"clamp(1, 2)", 1, 5, "'clamp' takes 3 arguments, not 2", ""},
                    BadText{"min(1)", 1, 3, "'min' takes at least 2 arguments, not 1", ""},
                    BadText{"max(1, )", 8, 1, "expected a value, found ')'", ""},
                    BadText{"1e999", 1, 5, "the number 1e999 is outside the range of a double", ""},
                    BadText{"t = 3", 3, 1, "unexpected '='",
                            "a formula has one side: instead of f = g write f - g, which is 0 there"},  //
                    BadText{"7 % 2", 3, 1, "unexpected '%'", "write mod(a, b) for the remainder"},
                    BadText{"2 × 3", 3, 1, "unexpected '×'", "write * for multiplication"},
                    BadText{"−2", 1, 1, "expected a value, found '−'",
                            "write the minus sign as - (the ASCII hyphen)"},
                    BadText{"t² × sin", 2, 1, "unexpected '²'", "write ^2"},
                    BadText{"2*π + sin", 3, 1, "expected a value, found 'π'", "write pi"}));

void expect_refused(const std::string& text, const std::string& message) {
  const auto result = Expression::parse(text, {});
  const auto* error = std::get_if<ExpressionError>(&result);
  ASSERT_NE(error, nullptr) << message;
  EXPECT_EQ(error->message, message);
}

TEST(ExpressionLimits, DeepNestingIsAnError) {
  const std::string message = "nested more than 200 deep";
  const std::size_t deep = 30000;
  expect_refused(std::string(deep, '(') + "1" + std::string(deep, ')'), message);
  expect_refused(std::string(deep, '(') + "1", message);
  expect_refused(std::string(deep, '-') + "1", message);
  std::string powers = "2";
  std::string calls;
  for (std::size_t i = 0; i < deep / 2; ++i) {
    powers += "^2";
    calls += "sin(";
  }
  expect_refused(powers, message);
  expect_refused(calls, "nested more than 200 deep");
}

TEST(ExpressionLimits, NestingUpToTheLimitIsRead) {
  const std::size_t depth = 199;
  const auto result = Expression::parse(std::string(depth, '(') + "1" + std::string(depth, ')'), {});
  ASSERT_TRUE(std::holds_alternative<Expression>(result));
  EXPECT_EQ(std::get<Expression>(result).constant(), 1.0);
}

TEST(ExpressionLimits, HugeTextsAreAnError) {
  const std::string message = "the expression is longer than 65536 bytes";
  expect_refused(std::string(100000, '(') + "1" + std::string(100000, ')'), message);
  expect_refused(std::string(10000000, ' '), message);
}

TEST(ExpressionLimits, LongFlatTextsAreRead) {
  std::string text = "t";
  for (int i = 1; i < 10000; ++i) text += "+t";
  const auto result = Expression::parse(text, {"t"});
  ASSERT_TRUE(std::holds_alternative<Expression>(result));
  EXPECT_EQ(std::get<Expression>(result).evaluate(std::vector<double>{0.5}), 5000.0);
}

// Pieces of real expressions in random order: whatever is accepted must evaluate, whatever is refused must
// say where, inside the text, and why.
TEST(ExpressionLimits, GarbageIsReadOrRefusedInsideTheText) {
  const std::vector<std::string> pieces{"1", "2.5", "e",   "pi",   "t",    "speed", "sin",  "min", "clamp",
                                        "(", ")",   ",",   "+",    "-",    "*",     "/",    "^",   " ",
                                        ".", "1e",  "foo", "(t)",  "×",    "\t",    "(",    "t",   "+",
                                        "2", "*t",  "^2",  "\xff", "\xc3", "max(",  "mod(", ",1)", "\n"};
  std::mt19937 random(20240229);
  int accepted = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string text;
    for (std::size_t count = random() % 12; count > 0; --count) text += pieces[random() % pieces.size()];
    const auto result = Expression::parse(text, {"t", "speed"});
    if (const auto* expression = std::get_if<Expression>(&result)) {
      ++accepted;
      const std::vector<double> values{0.3, 2.0};
      const double first = expression->evaluate(values);
      const double again = expression->evaluate(values);
      EXPECT_TRUE(first == again || (first != first && again != again)) << text;
      continue;
    }
    const auto& error = std::get<ExpressionError>(result);
    EXPECT_FALSE(error.message.empty()) << text;
    EXPECT_GE(error.column, 1) << text;
    EXPECT_LE(error.column, static_cast<int>(text.size()) + 1) << text;
    EXPECT_GE(error.length, 1) << text;
  }
  EXPECT_GT(accepted, 100);  // or the pieces no longer make expressions
}

}  // namespace
}  // namespace backlight
