// Compiled with -frounding-math; everything here runs while rounding upwards.
#include "backlight/expression/affine.h"

#include <array>
#include <cmath>
#include <vector>

#include "bounds.h"
#include "lane_affine.h"
#include "line_work.h"
#include "rounding.h"
#include "single_lane.h"

namespace backlight {
namespace {

using Form = LaneAffine<SingleLane>;

/// A form, and what is known of the expression.
struct AffineNumber {
  Form form{0.0};
  Continuity continuity = Continuity::continuous;

  AffineNumber() = default;
  explicit AffineNumber(double number);
  AffineNumber(const Form& f, Continuity c) : form(f), continuity(c) {}
  /// Without a slope.
  explicit AffineNumber(const Bounds& bounds);

  [[nodiscard]] double centre() const { return form.centre.number(); }
  [[nodiscard]] double slope() const { return form.slope.number(); }
  [[nodiscard]] double error() const { return form.error.number(); }
  [[nodiscard]] bool is_finite() const {
    return std::isfinite(centre()) && std::isfinite(slope()) && std::isfinite(error());
  }
  [[nodiscard]] bool is_constant() const { return slope() == 0.0 && error() == 0.0; }
  [[nodiscard]] Bounds bounds() const {
    if (continuity == Continuity::undefined) return nowhere();
    if (std::isinf(error())) return everything(continuity);
    const double reach = radius(form).number();
    return checked(reach - centre(), reach + centre(), continuity);
  }
};

AffineNumber::AffineNumber(double number) : AffineNumber(Bounds(number)) {
  if (std::isfinite(number)) form = Form(number);
}

AffineNumber::AffineNumber(const Bounds& bounds) : continuity(bounds.continuity) {
  if (bounds.is_undefined()) return;
  if (!std::isfinite(bounds.upper) || !std::isfinite(bounds.minus_lower)) {
    form.error = infinity;
    return;
  }
  form = without_slope<SingleLane>(bounds.minus_lower, bounds.upper);
  form.error = form.error + SingleLane(tiny);  // only the tape's constants are without an error
  if (!is_finite()) form = {0.0, 0.0, infinity};
}

struct Linear {
  double slope = 0.0;  ///< of the operation, along one operand
  double off = 0.0;    ///< by how much at most the true one differs
};

Linear linear(const Bounds& slope) {
  const Form middle = without_slope<SingleLane>(slope.minus_lower, slope.upper);
  return {middle.centre.number(), middle.error.number()};
}

/// By the mean value theorem, with the slopes that the table of operations has: what the operation is at the
/// centres, and its slopes over all values of the operands. No better than bounds without a slope: those.
AffineNumber by_mean_value(Operation operation, const AffineNumber& a, const AffineNumber& b) {
  const bool binary = info(operation).operands == 2;
  const Bounds all_a = a.bounds();
  const Bounds all_b = b.bounds();
  const Bounds all = apply<Bounds>(operation, all_a, all_b);
  const AffineNumber flat(all);
  if (all.continuity != Continuity::continuous || !flat.is_finite()) return flat;
  const Slopes<Bounds> slope =
      slopes<Bounds>(operation, all_a, all_b, all, !a.is_constant(), binary && !b.is_constant());
  const Bounds middle = apply<Bounds>(operation, Bounds(a.centre()), Bounds(b.centre()));
  if (middle.is_undefined() || slope.along_a.is_undefined() || slope.along_b.is_undefined()) return flat;
  const Form value = without_slope<SingleLane>(middle.minus_lower, middle.upper);
  const Linear along_a = linear(slope.along_a);
  const Linear along_b = linear(slope.along_b);
  const double part_a = along_a.slope * a.slope();
  const double part_b = along_b.slope * b.slope();
  const double steepest_a = std::abs(along_a.slope) * a.error() + along_a.off * radius(a.form).number();
  const double steepest_b = std::abs(along_b.slope) * b.error() + along_b.off * radius(b.form).number();
  const double rounding = 0x1p-50 * (std::abs(part_a) + std::abs(part_b)) + tiny;
  const AffineNumber result(
      {value.centre, part_a + part_b, value.error + ((steepest_a + steepest_b) + rounding)}, all.continuity);
  return result.is_finite() && result.error() < flat.error() ? result : flat;
}

/// Whether the rules for lanes hold for these operands.
bool has_form(Operation operation, const AffineNumber& a, const AffineNumber& b) {
  const auto least = [](const AffineNumber& x) { return -(radius(x.form).number() - std::abs(x.centre())); };
  switch (operation) {
    case Operation::divide:
      return least(b) > 0.0;
    case Operation::sqrt:
      return a.centre() >= 0.0 && least(a) >= 0.0;
    case Operation::sin:
    case Operation::cos:
      return std::abs(a.centre()) <= largest_wave_argument;
    default:
      return true;
  }
}

/// The rules for a constant operand (LineKernel has the same for lanes).
bool apply_to_constant(Operation operation, const AffineNumber& a, const AffineNumber& b, Form& result) {
  if (operation == Operation::add && b.is_constant()) {
    result = plus_constant(a.form, b.form.centre);
  } else if (operation == Operation::add && a.is_constant()) {
    result = plus_constant(b.form, a.form.centre);
  } else if (operation == Operation::subtract && b.is_constant()) {
    result = plus_constant(a.form, -b.form.centre);
  } else if (operation == Operation::subtract && a.is_constant()) {
    result = plus_constant(-b.form, a.form.centre);
  } else if (operation == Operation::multiply && b.is_constant()) {
    result = times_constant(a.form, b.form.centre);
  } else if (operation == Operation::multiply && a.is_constant()) {
    result = times_constant(b.form, a.form.centre);
  } else {
    return false;
  }
  return true;
}

bool has_rule(Operation operation) {
  switch (operation) {
    case Operation::add:
    case Operation::subtract:
    case Operation::multiply:
    case Operation::divide:
    case Operation::negate:
    case Operation::square:
    case Operation::integer_power:
    case Operation::sin:
    case Operation::cos:
    case Operation::sqrt:
    case Operation::abs:
    case Operation::min:
    case Operation::max:
      return true;
    default:
      return false;
  }
}

}  // namespace

template <>
AffineNumber apply<AffineNumber>(Operation operation, const AffineNumber& a, const AffineNumber& b) {
  const bool binary = info(operation).operands == 2;
  const Continuity continuity = binary ? std::max(a.continuity, b.continuity) : a.continuity;
  if (continuity == Continuity::undefined) return AffineNumber(nowhere());
  if (a.is_finite() && (!binary || b.is_finite())) {
    if (!has_rule(operation)) return by_mean_value(operation, a, binary ? b : a);
    if (has_form(operation, a, b)) {
      Form form;
      if (!apply_to_constant(operation, a, b, form)) form = apply<Form>(operation, a.form, b.form);
      const AffineNumber result(form, continuity);
      if (result.is_finite()) return result;
    }
  }
  return AffineNumber(apply<Bounds>(operation, a.bounds(), binary ? b.bounds() : a.bounds()));
}

void affine_of_each(Operation operation, std::size_t lanes, const double* operands, double* results) {
  const auto number = [&](std::size_t first) {
    return AffineNumber({operands[first], operands[first + lanes], operands[first + 2 * lanes]},
                        Continuity::continuous);
  };
  for (std::size_t i = 0; i < lanes; ++i) {
    const AffineNumber result = apply<AffineNumber>(operation, number(i), number(i + 3 * lanes));
    if (result.continuity != Continuity::continuous || !result.is_finite()) note_trouble();
    results[i] = result.centre();
    results[i + lanes] = result.slope();
    results[i + 2 * lanes] = result.error();
  }
}

namespace {

[[gnu::noinline]] AffineNumber run_form(const Tape& tape, const VariableLine& line, double from, double to) {
  std::vector<AffineNumber> variables;
  variables.reserve(line.origin.size());
  for (std::size_t i = 0; i < line.origin.size(); ++i) {
    Form* const kind = nullptr;
    variables.emplace_back(on_line<SingleLane>(line.origin[i], line.direction[i], from, to, kind),
                           Continuity::continuous);
  }
  std::vector<AffineNumber> registers(tape.registers);
  return run<AffineNumber>(tape, variables, registers);
}

[[gnu::noinline]] ZeroRegion region_of(const AffineNumber& f, double from, double to) {
  if (f.continuity == Continuity::undefined || !f.is_finite()) return {from, to, 0, f.continuity};
  const LaneZeros<SingleLane> zeros = zeros_of<SingleLane>(f.form, from, to);
  const int sign = zeros.sign.number() > 0.0 ? 1 : -1;
  if (zeros.none.v) return {to, from, sign, f.continuity};
  return {zeros.first.number(), zeros.last.number(), sign, f.continuity};
}

}  // namespace

AffineForm enclose_affine(const Tape& tape, const VariableLine& line, double from, double to) {
  const RoundUp mode;
  const AffineNumber f = run_form(tape, line, from, to);
  return {f.centre(), f.slope(), f.error(), f.continuity};
}

ZeroRegion enclose_zeros(const Tape& tape, const VariableLine& line, double from, double to) {
  const RoundUp mode;
  return region_of(run_form(tape, line, from, to), from, to);
}

}  // namespace backlight
