// Formulas as polynomials along lines: their values in exact arithmetic are within the error that is told,
// the error is small, and every width of the lanes gives the same bits.
#include "backlight/expression/line_polynomials.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "backlight/base/instruction_sets.h"
#include "backlight/expression/expression.h"
#include "backlight/expression/line_program.h"
#include "exact_operations.h"

namespace backlight {
namespace {

constexpr std::size_t variables = LineBatch::most_variables;
constexpr mpfr_prec_t bits = 2300;

Tape tape_of(const std::string& text) {
  return std::get<Expression>(Expression::parse(text, {"x", "y", "z", "t"})).tape();
}

class Number {
 public:
  Number(double value = 0.0) {  // NOLINT: as a double is
    mpfr_init2(v_, bits);
    mpfr_set_d(v_, value, MPFR_RNDN);
  }
  Number(const Number& other) : Number() { mpfr_set(v_, other.v_, MPFR_RNDN); }
  Number& operator=(const Number& other) {
    mpfr_set(v_, other.v_, MPFR_RNDN);
    return *this;
  }
  ~Number() { mpfr_clear(v_); }

  static Number of(Operation operation, const Number& a, const Number& b) {
    Number result;
    test::exact(result.v_, operation, a.v_, b.v_, MPFR_RNDN);
    return result;
  }
  friend Number operator+(const Number& a, const Number& b) { return of(Operation::add, a, b); }
  friend Number operator-(const Number& a, const Number& b) { return of(Operation::subtract, a, b); }
  friend Number operator*(const Number& a, const Number& b) { return of(Operation::multiply, a, b); }
  [[nodiscard]] double number() const { return mpfr_get_d(v_, MPFR_RNDA); }

 private:
  mpfr_t v_;
};

Number value(const Tape& tape, const std::array<Number, variables>& at) {
  std::vector<Number> registers(tape.registers);
  for (const Instruction& step : tape.instructions) {
    Number result;
    if (step.operation == Operation::constant) {
      result = Number(tape.constants[step.a]);
    } else if (step.operation == Operation::variable) {
      result = at[step.a];
    } else {
      result = Number::of(step.operation, registers[step.a], registers[step.b]);
    }
    registers[step.out] = result;
  }
  return registers[0];
}

/// Pieces that are long, short, far from the origin, along an axis.
LineBatch random_lines(std::size_t count) {
  LineBatch lines(count);
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> place(-2.0, 2.0);
  std::uniform_real_distribution<double> exponent(-12.0, 1.0);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t v = 0; v < variables; ++v) {
      lines.origin(v)[i] = i % 7 == 3 ? 0.0 : place(generator) * (i % 5 == 0 ? 1e3 : 1.0);
      lines.direction(v)[i] = i % 6 == v ? 0.0 : place(generator);
    }
    lines.from()[i] = place(generator);
    lines.to()[i] = lines.from()[i] + std::pow(10.0, exponent(generator));
  }
  return lines;
}

class Polynomials : public testing::TestWithParam<std::string> {};

TEST_P(Polynomials, AreTheFormulaToWithinTheirError) {
  const Tape tape = tape_of(GetParam());
  const LineProgram program(tape);
  constexpr std::size_t count = LinePolynomials::most;
  LineBatch lines = random_lines(count);
  std::vector<double> workspace;
  LinePolynomials found;
  program.polynomials(lines, count, workspace, found);
  ASSERT_EQ(found.degree, *program.degree());
  std::size_t small = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double half = found.half[i];
    EXPECT_GE((Number(lines.from()[i]) + Number(2.0) * Number(half) - Number(lines.to()[i])).number(), 0.0);
    double size = 0.0;
    for (int k = 0; k <= found.degree; ++k) size += std::abs(found.coefficient[k][i]);
    small += found.error[i] < 1e-13 * size ? 1U : 0U;
    for (const double at : {-1.0, -0.7, 0.0, 0.1, 0.9, 1.0}) {
      const Number s = Number(lines.from()[i]) + Number(half) * (Number(1.0) + Number(at));
      std::array<Number, variables> place;
      for (std::size_t v = 0; v < variables; ++v) {
        place[v] = Number(lines.origin(v)[i]) + s * Number(lines.direction(v)[i]);
      }
      Number sum(0.0);
      for (int k = found.degree; k >= 0; --k) sum = sum * Number(at) + Number(found.coefficient[k][i]);
      EXPECT_LE(std::abs((value(tape, place) - sum).number()), found.error[i]) << i << " at " << at;
    }
  }
  EXPECT_GE(small, count * 3 / 4);  // on some lines the formula itself cancels
}

TEST_P(Polynomials, HaveTheSameBitsForEveryWidthAndAlone) {
  const Tape tape = tape_of(GetParam());
  constexpr std::size_t count = 61;
  LineBatch lines = random_lines(count);
  std::vector<double> workspace;
  LinePolynomials widest;
  LineProgram(tape).polynomials(lines, count, workspace, widest);
  const auto expect_same = [&](const LinePolynomials& other, std::size_t its, std::size_t i) {
    EXPECT_EQ(other.error[its], widest.error[i]) << i;
    EXPECT_EQ(other.half[its], widest.half[i]) << i;
    for (int k = 0; k <= widest.degree; ++k) {
      EXPECT_EQ(other.coefficient[k][its], widest.coefficient[k][i]) << i;
    }
  };
  LinePolynomials other;
  std::vector<LineWidth> widths{LineWidth::baseline};
  if (has_avx2()) widths.push_back(LineWidth::avx2);
  for (const LineWidth width : widths) {
    LineProgram(tape, width).polynomials(lines, count, workspace, other);
    for (std::size_t i = 0; i < count; ++i) expect_same(other, i, i);
  }
  LineBatch alone(1);
  for (std::size_t v = 0; v < variables; ++v) {
    alone.origin(v)[0] = lines.origin(v)[17];
    alone.direction(v)[0] = lines.direction(v)[17];
  }
  alone.from()[0] = lines.from()[17];
  alone.to()[0] = lines.to()[17];
  LineProgram(tape).polynomials(alone, 1, workspace, other);
  expect_same(other, 0, 17);
}

INSTANTIATE_TEST_SUITE_P(
    Formulas, Polynomials,
    testing::Values("x", "x - 3", "4 - y*z", "x^2 + y^2 + z^2 - 1", "-x^3*y/7 + 2*z*t",
                    "4*(2.618*x^2-y^2)*(2.618*y^2-z^2)*(2.618*z^2-x^2)-4.236*(x^2+y^2+z^2-1)^2",
                    "(x+y)^5 - (y-z)^7 + x^12", "2*(2*(2*x^2-1)^2-1)^2 + y^8*1e-3 - t",
                    "x*y*z*t*(x-y)*(y-z)*(z-t)"));

TEST(Polynomials, HaveADegreeWhereTheyAreSome) {
  const auto degree = [](const char* text) { return LineProgram(tape_of(text)).degree(); };
  EXPECT_EQ(degree("x*y - 2"), 2);
  EXPECT_EQ(degree("(x^3 + y)^4/5"), 12);
  EXPECT_EQ(degree("x^13"), std::nullopt);
  EXPECT_EQ(degree("x^7*y^6"), std::nullopt);
  EXPECT_EQ(degree("x^(-2)"), std::nullopt);
  EXPECT_EQ(degree("x/y"), std::nullopt);
  EXPECT_EQ(degree("abs(x) + y"), std::nullopt);
  EXPECT_EQ(degree("x + sin(y)*0.1"), std::nullopt);
}

TEST(Polynomials, TooLargeForADoubleHaveNoBoundOfTheirError) {
  const LineProgram program(tape_of("(x*1e200)^2 - y"));
  LineBatch lines(1);
  lines.direction(0)[0] = 1.0;
  lines.direction(1)[0] = 1.0;
  lines.to()[0] = 1.0;
  std::vector<double> workspace;
  LinePolynomials found;
  program.polynomials(lines, 1, workspace, found);
  EXPECT_FALSE(std::isfinite(found.error[0]));
}

}  // namespace
}  // namespace backlight
