// Every row of the table of operations over affine forms, against MPFR; and what a form says about zeros.
#include "backlight/expression/affine.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <cmath>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "backlight/expression/expression.h"
#include "continuity_cases.h"
#include "exact_operations.h"

namespace backlight {
namespace {

using test::nasty;

constexpr mpfr_prec_t precision = 2300;  // sums of any two doubles are exact

struct Line {
  std::vector<double> origin, direction;
};

/// Whether operation(origin + ε direction) lies within the form, exactly, for an ε in [-1, 1].
class Judge {
 public:
  Judge() { mpfr_inits2(precision, x, y, v, f, off, nullptr); }
  ~Judge() { mpfr_clears(x, y, v, f, off, nullptr); }
  Judge(const Judge&) = delete;
  Judge& operator=(const Judge&) = delete;

  /// NaN where the operation has no value.
  enum class Verdict { inside, outside, no_value };
  Verdict operator()(Operation operation, const Line& line, const AffineForm& form, double at) {
    place(x, line.origin[0], line.direction[0], at);
    place(y, line.origin[1], line.direction[1], at);
    if (operation == Operation::integer_power || operation == Operation::add ||
        operation == Operation::multiply || operation == Operation::subtract) {
      mpfr_set_prec(v, precision);
    } else {
      mpfr_set_prec(v, 300);  // no sum is made of it but with the form
    }
    test::exact(v, operation, x, y, MPFR_RNDN);
    if (mpfr_number_p(v) == 0) return Verdict::no_value;
    place(f, form.centre, form.slope, at);
    mpfr_sub(off, v, f, MPFR_RNDN);
    mpfr_abs(off, off, MPFR_RNDN);
    // What MPFR rounded, beyond the 290th bit of the value, is not held against the form.
    mpfr_div_2ui(v, v, 290, MPFR_RNDN);
    mpfr_abs(v, v, MPFR_RNDN);
    mpfr_sub(off, off, v, MPFR_RNDN);
    return mpfr_cmp_d(off, form.error) <= 0 ? Verdict::inside : Verdict::outside;
  }

 private:
  static void place(mpfr_t to, double origin, double direction, double at) {
    mpfr_set_d(to, direction, MPFR_RNDN);
    mpfr_mul_d(to, to, at, MPFR_RNDN);
    mpfr_add_d(to, to, origin, MPFR_RNDN);
  }

  mpfr_t x, y, v, f, off;
};

AffineForm form_of(Operation operation, const Line& line) {
  // Middle 0 and half 1 are exact: ε is the parameter of the line.
  return enclose_affine(test::tape_of(operation), {line.origin, line.direction}, -1.0, 1.0);
}

class EveryForm : public testing::TestWithParam<OperationInfo> {};

TEST_P(EveryForm, HoldsTheExactValues) {
  const OperationInfo& row = GetParam();
  std::mt19937 random(5);
  std::uniform_int_distribution<std::size_t> any(0, nasty.size() - 1);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  Judge judge;
  int judged = 0;
  const bool exponent = row.operation == Operation::integer_power;
  for (int i = 0; i < 700; ++i) {
    // Wide pieces, and from every third on narrow ones.
    const double narrow = i % 3 == 0 ? std::ldexp(1.0, -(i % 50)) : 1.0;
    const Line line{
        {nasty[any(random)], exponent ? 1.0 + i % 12 : nasty[any(random)]},
        {narrow * nasty[any(random)], exponent || i % 4 == 0 ? 0.0 : narrow * nasty[any(random)]}};
    const AffineForm form = form_of(row.operation, line);
    if (std::isinf(form.error) || form.continuity == Continuity::undefined) continue;
    ASSERT_TRUE(std::isfinite(form.centre) && std::isfinite(form.slope) && form.error >= 0.0);
    for (const double at : {-1.0, 1.0, 0.0, share(random), share(random)}) {
      const auto verdict = judge(row.operation, line, form, at);
      if (verdict == Judge::Verdict::no_value) {
        EXPECT_GE(form.continuity, Continuity::partial) << line.origin[0] << ' ' << line.direction[0];
        continue;
      }
      ++judged;
      EXPECT_EQ(verdict, Judge::Verdict::inside)
          << line.origin[0] << " + " << at << " * " << line.direction[0] << ", " << line.origin[1] << " + "
          << at << " * " << line.direction[1] << ": " << form.centre << " + " << form.slope << " +- "
          << form.error;
    }
  }
  EXPECT_GT(judged, 120);
}

// What is not linear goes into the error, and that shrinks as the square of the piece.
TEST_P(EveryForm, GetsBetterWithTheSquareOfThePiece) {
  const OperationInfo& row = GetParam();
  if (row.operation == Operation::floor) return;
  Line line{{0.4375, row.operation == Operation::integer_power ? 5.0 : 0.8125},
            {0x1p-8, row.operation == Operation::integer_power ? 0.0 : 0x1p-9}};
  const AffineForm coarse = form_of(row.operation, line);
  for (double& d : line.direction) d *= 0x1p-8;
  const AffineForm fine = form_of(row.operation, line);
  EXPECT_LT(coarse.error, 2e-4);
  EXPECT_LT(fine.error, 0x1p-15 * coarse.error + 1e-14);
  EXPECT_EQ(fine.continuity, Continuity::continuous);
  EXPECT_GT(std::abs(fine.slope), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Table, EveryForm, testing::ValuesIn(operation_table));

Tape tape_of(const std::string& text) {
  const auto result = Expression::parse(text, {"x"});
  if (const auto* error = std::get_if<ExpressionError>(&result))
    ADD_FAILURE() << text << ": " << error->message;
  return std::get<Expression>(result).tape();
}

AffineForm over(const std::string& text, double low, double high) {
  const std::vector<double> origin{0.0}, direction{1.0};
  return enclose_affine(tape_of(text), {origin, direction}, low, high);
}

ZeroRegion zeros(const std::string& text, double low, double high) {
  const std::vector<double> origin{0.0}, direction{1.0};
  return enclose_zeros(tape_of(text), {origin, direction}, low, high);
}

TEST(Affine, SeesWhatIntervalsDoNot) {
  EXPECT_LT(over("x - x", 0.0, 1.0).error, 1e-15);
  EXPECT_EQ(over("x - x", 0.0, 1.0).slope, 0.0);
  EXPECT_LT(over("3*x - 2*(x + 1) - x", -5.0, 9.0).error, 1e-13);
}

TEST(Affine, FlagsWhereThereIsNoContinuity) {
  for (const auto& [text, flag] : continuity_about_zero()) {
    EXPECT_EQ(over(text, -0.5, 0.5).continuity, flag) << text;
  }
  EXPECT_EQ(over("sin(1e7*x)", -0.5, 0.5).continuity, Continuity::continuous);
}

TEST(Affine, ZerosAreWithinTheRegion) {
  const ZeroRegion none = zeros("x^2 + 1", -1.0, 1.0);
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.sign, 1);
  EXPECT_EQ(zeros("-1 - x^2", -1.0, 1.0).sign, -1);

  const ZeroRegion rising = zeros("x - 0.25", -1.0, 1.0);
  EXPECT_LE(rising.first, 0.25);
  EXPECT_GE(rising.last, 0.25);
  EXPECT_NEAR(rising.first, 0.25, 1e-15);
  EXPECT_NEAR(rising.last, 0.25, 1e-15);
  EXPECT_EQ(rising.sign, -1);
  EXPECT_EQ(zeros("0.25 - x", -1.0, 1.0).sign, 1);

  const ZeroRegion curved = zeros("x^2 - 2", 1.0, 2.0);
  EXPECT_GT(curved.first, 1.2);
  EXPECT_LE(curved.first, std::sqrt(2.0));
  EXPECT_GE(curved.last, std::sqrt(2.0));
  EXPECT_LT(curved.last, 1.6);
}

TEST(Affine, ZerosNeverLeaveThePiece) {
  for (const char* text : {"x", "x^3 - 0.001", "sin(5*x)", "(x - 1)*(x + 1)", "x^2", "0*x", "abs(x) - 1"}) {
    const ZeroRegion region = zeros(text, -1.0, 1.0);
    EXPECT_FALSE(region.empty()) << text;
    EXPECT_GE(region.first, -1.0) << text;
    EXPECT_LE(region.last, 1.0) << text;
  }
}

}  // namespace
}  // namespace backlight
