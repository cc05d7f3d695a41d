// Expressions along many lines at once: the bounds hold, every width of the lanes gives the same bits, and no
// line depends on the others.
#include "backlight/expression/line_program.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <variant>

#include "backlight/base/instruction_sets.h"
#include "backlight/base/lane_waves.h"
#include "backlight/expression/affine.h"
#include "backlight/expression/compose.h"
#include "backlight/expression/enclosure.h"
#include "backlight/expression/expression.h"

namespace backlight {
namespace {

constexpr std::size_t variables = LineBatch::most_variables;

/// The widths that this processor has, besides the one that is taken.
std::vector<LineWidth> narrower_widths() {
  if (has_avx2()) return {LineWidth::baseline, LineWidth::avx2};
  return {LineWidth::baseline};
}

Tape tape_of(const std::string& text) {
  auto parsed = Expression::parse(text, {"x", "y", "z", "t"});
  if (const auto* wrong = std::get_if<ExpressionError>(&parsed)) {
    ADD_FAILURE() << text << ": " << wrong->message;
    return Expression{}.tape();
  }
  return std::get<Expression>(parsed).tape();
}

// Every operation of the table, where it is smooth, at kinks, at poles, and outside its domain.
const std::vector<std::string> formulas{
    "x + y - 2*z",
    "x*y*z - 0.3",
    "x/(y*y + 1) - z",
    "x/y",
    "-x^2 + y^3 - z^7 + x^33",
    "x^(-3)",
    "sin(3*x)*cos(2*y) + sin(z)",
    "sin(1e5*x) + cos(1e9*y)",
    "tan(x)",
    "asin(x) + acos(y)",
    "atan(x)*atan2(y, z)",
    "sinh(x) - cosh(y)*tanh(z)",
    "exp(x*y) - log(z + 2)",
    "log(x)",
    "sqrt(x^2 + y^2) - 1",
    "sqrt(x)",
    "cbrt(x*y)",
    "abs(x) - abs(y*z)",
    "floor(3*x) + mod(y, 0.7)",
    "min(x, y, z) - max(x*y, 0.2, t)",
    "pow(abs(x) + 0.1, y)",
    "pow(2, x) - pow(y, 2.5)",
    "(x^2+y^2+z^2-1)^2*1e200*1e200",
    "0*x + 1/0",
    // What is defined nowhere is passed on, as is what no number reaches.
    "mod(y, log(x))",
    "pow(x*x + y*y - 1/(1/0), 1/x)^-1e9",
    "1/log(x) - 1/sqrt(-1 - y^2)",
    "tan(exp(1e3*x) - exp(1e3*y))",
    "3",
};

LineBatch random_lines(std::size_t count, unsigned seed) {
  LineBatch lines(count);
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> place(-2.0, 2.0);
  std::uniform_real_distribution<double> exponent(-16.0, 0.5);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t v = 0; v < variables; ++v) {
      lines.origin(v)[i] = place(generator);
      lines.direction(v)[i] = place(generator);
    }
    lines.from()[i] = place(generator);
    lines.to()[i] = lines.from()[i] + std::pow(10.0, exponent(generator));
  }
  return lines;
}

struct Found {
  double lower, upper, slope_lower, slope_upper, continuity;
};

std::vector<Found> pieces_of(const LineProgram& program, LineBatch& lines, std::size_t count) {
  std::vector<double> workspace;
  program.enclose_pieces(lines, count, workspace);
  std::vector<Found> found;
  for (std::size_t i = 0; i < count; ++i) {
    found.push_back({lines.lower()[i], lines.upper()[i], lines.slope_lower()[i], lines.slope_upper()[i],
                     lines.continuity()[i]});
  }
  return found;
}

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));  // 0 and -0 are the same bound
}

bool same(const Found& a, const Found& b) {
  return same(a.lower, b.lower) && same(a.upper, b.upper) && same(a.slope_lower, b.slope_lower) &&
         same(a.slope_upper, b.slope_upper) && a.continuity == b.continuity;
}

class LineFormulas : public testing::TestWithParam<std::string> {};

TEST_P(LineFormulas, BoundsHoldValuesAndSlopesOfThePiece) {
  const Tape tape = tape_of(GetParam());
  const Expression f = std::get<Expression>(Expression::parse(GetParam(), {"x", "y", "z", "t"}));
  LineBatch lines = random_lines(200, 11);
  const auto found = pieces_of(LineProgram(tape), lines, 200);
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const double part : {0.0, 0.3, 0.5, 0.77, 1.0}) {
      const double s = lines.from()[i] + part * (lines.to()[i] - lines.from()[i]);
      if (!(s <= lines.to()[i])) continue;
      std::array<Dual, variables> at;
      for (std::size_t v = 0; v < variables; ++v) {
        at[v] = {lines.origin(v)[i] + s * lines.direction(v)[i], lines.direction(v)[i]};
      }
      const Dual exact = f.evaluate(at);
      if (!std::isfinite(exact.value)) continue;
      // The law itself is rounded, in every one of its steps; so are the points of the line.
      const double room = 1e-13 * (1.0 + std::abs(exact.value) + std::abs(exact.derivative));
      EXPECT_LE(found[i].lower, exact.value + room);
      EXPECT_GE(found[i].upper, exact.value - room);
      if (!std::isfinite(exact.derivative) || found[i].continuity > 0.0) continue;
      const double slope_room = 1e-9 * (1.0 + std::abs(exact.derivative));
      EXPECT_LE(found[i].slope_lower, exact.derivative + slope_room);
      EXPECT_GE(found[i].slope_upper, exact.derivative - slope_room);
    }
  }
}

TEST_P(LineFormulas, ANarrowPieceHasNarrowBounds) {
  const Tape tape = tape_of(GetParam());
  LineBatch lines = random_lines(100, 13);
  for (std::size_t i = 0; i < 100; ++i) lines.to()[i] = lines.from()[i];
  LineBatch again = lines;
  const auto lanes = pieces_of(LineProgram(tape), lines, 100);
  for (std::size_t i = 0; i < 100; ++i) {
    std::array<double, variables> origin{};
    std::array<double, variables> direction{};
    for (std::size_t v = 0; v < variables; ++v) {
      origin[v] = again.origin(v)[i];
      direction[v] = again.direction(v)[i];
    }
    const Interval careful = enclose(tape, {origin, direction}, again.from()[i]);
    if (careful.continuity != Continuity::continuous || !std::isfinite(careful.upper - careful.lower))
      continue;
    // Two enclosures of one number: they overlap, and neither is much wider.
    EXPECT_LE(lanes[i].lower, careful.upper);
    EXPECT_GE(lanes[i].upper, careful.lower);
    EXPECT_LE(lanes[i].upper - lanes[i].lower, 4.0 * (careful.upper - careful.lower) + 1e-300);
  }
}

TEST_P(LineFormulas, NoLineDependsOnTheOthersNorOnTheWidth) {
  const Tape tape = tape_of(GetParam());
  constexpr std::size_t count = 61;
  LineBatch lines = random_lines(count, 17);
  const LineProgram program(tape);
  const auto together = pieces_of(program, lines, count);
  std::vector<double> workspace;
  program.numbers(lines, count, workspace);
  const std::vector<double> values(lines.value(), lines.value() + count);
  for (const LineWidth width : narrower_widths()) {
    const LineProgram narrow(tape, width);
    const auto pieces = pieces_of(narrow, lines, count);
    narrow.numbers(lines, count, workspace);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_TRUE(same(together[i], pieces[i])) << i;
      EXPECT_TRUE(same(values[i], lines.value()[i])) << i;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    LineBatch alone(1);
    for (std::size_t v = 0; v < variables; ++v) {
      alone.origin(v)[0] = lines.origin(v)[i];
      alone.direction(v)[0] = lines.direction(v)[i];
    }
    alone.from()[0] = lines.from()[i];
    alone.to()[0] = lines.to()[i];
    EXPECT_TRUE(same(together[i], pieces_of(program, alone, 1)[0])) << i;
  }
}

// Affine forms over lanes are those of the scalar type, to the last bit, whatever the width and the company.
TEST_P(LineFormulas, ZerosAreThoseOfTheLaw) {
  const Tape tape = tape_of(GetParam());
  constexpr std::size_t count = 203;
  LineBatch lines = random_lines(count, 29);
  std::vector<double> workspace;
  std::vector<LineWidth> widths = narrower_widths();
  widths.push_back(LineWidth::automatic);
  for (const LineWidth width : widths) {
    LineProgram(tape, width).enclose_zeros(lines, count, workspace);
    for (std::size_t i = 0; i < count; ++i) {
      std::array<double, variables> origin{};
      std::array<double, variables> direction{};
      for (std::size_t v = 0; v < variables; ++v) {
        origin[v] = lines.origin(v)[i];
        direction[v] = lines.direction(v)[i];
      }
      const ZeroRegion law = enclose_zeros(tape, {origin, direction}, lines.from()[i], lines.to()[i]);
      EXPECT_EQ(lines.first_zero()[i], law.first) << i;
      EXPECT_EQ(lines.last_zero()[i], law.last) << i;
      EXPECT_EQ(lines.sign()[i], law.sign) << i;
      EXPECT_EQ(lines.continuity()[i], static_cast<double>(law.continuity)) << i;
    }
  }
}

TEST_P(LineFormulas, NumbersAreThoseOfTheLaw) {
  const Tape tape = tape_of(GetParam());
  const Expression f = std::get<Expression>(Expression::parse(GetParam(), {"x", "y", "z", "t"}));
  LineBatch lines = random_lines(100, 19);
  std::vector<double> workspace;
  LineProgram(tape).numbers(lines, 100, workspace);
  for (std::size_t i = 0; i < 100; ++i) {
    std::array<Dual, variables> at;
    for (std::size_t v = 0; v < variables; ++v) {
      at[v] = {lines.origin(v)[i] + lines.from()[i] * lines.direction(v)[i], lines.direction(v)[i]};
    }
    const Dual law = f.evaluate(at);
    if (!std::isfinite(law.value)) {
      EXPECT_FALSE(std::isfinite(lines.value()[i]));
      continue;
    }
    EXPECT_NEAR(lines.value()[i], law.value, 1e-13 * (1.0 + std::abs(law.value)));
    if (std::isfinite(law.derivative)) {
      EXPECT_NEAR(lines.slope()[i], law.derivative, 1e-12 * (1.0 + std::abs(law.derivative)));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table, LineFormulas, testing::ValuesIn(formulas),
                         [](const auto& test) { return std::to_string(test.index); });

TEST(Waves, AreWithinTheirBoundOfTheExactValues) {
  std::mt19937_64 generator(23);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  double worst = 0.0;
  mpfr_t x, v;
  mpfr_inits2(200, x, v, nullptr);
  for (int i = 0; i < 40000; ++i) {
    // Everywhere, and close to the multiples of a quarter turn.
    double a = largest_wave_argument * std::pow(10.0, -8.0 * std::abs(unit(generator))) * unit(generator);
    if (i % 2 == 0) a = std::nearbyint(a) * 1.5707963267948966 * (1.0 + 1e-15 * unit(generator));
    if (std::abs(a) > largest_wave_argument) continue;
    const auto w = waves(Lanes<2>(a));
    mpfr_set_d(x, a, MPFR_RNDN);
    mpfr_sin(v, x, MPFR_RNDN);
    mpfr_sub_d(v, v, w.sine.v[0], MPFR_RNDN);
    worst = std::max(worst, std::abs(mpfr_get_d(v, MPFR_RNDN)));
    mpfr_cos(v, x, MPFR_RNDN);
    mpfr_sub_d(v, v, w.cosine.v[0], MPFR_RNDN);
    worst = std::max(worst, std::abs(mpfr_get_d(v, MPFR_RNDN)));
  }
  mpfr_clears(x, v, nullptr);
  EXPECT_LT(worst, wave_error);
  EXPECT_GT(worst, 0.0);
}

struct ManyResults {
  double numbers[3][2][40], forms[3][3][40];

  void find(const LineProgram& program, LineBatch& lines, std::size_t count) {
    std::vector<double> workspace;
    const LineNumbers number_rows[3]{
        {numbers[0][0], numbers[0][1]}, {numbers[1][0], numbers[1][1]}, {numbers[2][0], numbers[2][1]}};
    const LineForms form_rows[3]{{forms[0][0], forms[0][1], forms[0][2]},
                                 {forms[1][0], forms[1][1], forms[1][2]},
                                 {forms[2][0], forms[2][1], forms[2][2]}};
    program.all_numbers(lines, count, workspace, number_rows);
    program.forms(lines, count, workspace, form_rows);
  }
};

// Formulas that have parts in common, one of them twice, on one tape: each is what it is by itself.
TEST(LineProgram, SeveralResultsAreThoseOfEachAlone) {
  constexpr std::size_t count = 37;
  const std::vector<std::string> texts{"x*cos(3*t) - y*sin(3*t)", "x*sin(3*t) + y*cos(3*t) + sqrt(z + 3.5)",
                                       "x*cos(3*t) - y*sin(3*t)"};
  Composer composer(variables);
  std::vector<Composer::Node> at, results;
  for (std::size_t v = 0; v < variables; ++v) at.push_back(composer.variable(v));
  for (const std::string& text : texts) {
    results.push_back(
        composer.insert(std::get<Expression>(Expression::parse(text, {"x", "y", "z", "t"})), at));
  }
  const LineProgram together(composer.tape(results));
  LineBatch lines = random_lines(count, 11);
  ManyResults all;
  all.find(together, lines, count);
  std::size_t without_form = 0;
  for (std::size_t r = 0; r < 3; ++r) {
    const Tape alone = tape_of(texts[r]);
    for (std::size_t i = 0; i < count; ++i) {
      std::array<double, variables> origin{}, direction{};
      for (std::size_t v = 0; v < variables; ++v) {
        origin[v] = lines.origin(v)[i];
        direction[v] = lines.direction(v)[i];
      }
      const double from = lines.from()[i], to = lines.to()[i];
      const AffineForm form = enclose_affine(alone, {origin, direction}, from, to);
      const double* const found[3]{all.forms[r][0] + i, all.forms[r][1] + i, all.forms[r][2] + i};
      if (std::isinf(*found[2])) {
        EXPECT_LE(origin[2] + std::min(from * direction[2], to * direction[2]), -3.5 + 1e-9) << "others have";
        ++without_form;
      } else {
        EXPECT_EQ(*found[0], form.centre);
        EXPECT_EQ(*found[1], form.slope);
        EXPECT_EQ(*found[2], form.error);
      }
      LineBatch one(1);
      one.put(0, origin, direction, from, to);
      std::vector<double> workspace;
      LineProgram(alone).numbers(one, 1, workspace);
      EXPECT_TRUE(same(all.numbers[r][0][i], one.value()[0]));
      EXPECT_TRUE(same(all.numbers[r][1][i], one.slope()[0]));
    }
  }
  EXPECT_GT(without_form, 0U);
  EXPECT_LT(without_form, count / 2);
  for (const LineWidth width : narrower_widths()) {
    ManyResults narrow;
    narrow.find(LineProgram(together.tape(), width), lines, count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t r = 0; r < 3; ++r) {
        for (int k = 0; k < 3; ++k) EXPECT_EQ(narrow.forms[r][k][i], all.forms[r][k][i]);
        for (int k = 0; k < 2; ++k) EXPECT_TRUE(same(narrow.numbers[r][k][i], all.numbers[r][k][i]));
      }
    }
  }
}

}  // namespace
}  // namespace backlight
