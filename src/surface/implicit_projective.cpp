#include "implicit_projective.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "backlight/expression/compose.h"

namespace backlight {
namespace {

constexpr std::size_t most_unknowns = 64;
enum Variable : std::size_t { first, second, w, t, first_unknown };

/// s^degree · regular.
struct Grown {
  Composer::Node regular = 0;
  double degree = 0.0;
  std::optional<double> constant{};
  bool never_negative = false;
};

class Homogenizer {
 public:
  Homogenizer(int axis, double side) : composer_(first_unknown + most_unknowns), axis_(axis), side_(side) {}

  std::optional<ProjectiveFormula> of(const Expression& f) {
    const Tape& tape = f.tape();
    std::vector<Grown> registers(tape.registers);
    for (const Instruction& step : tape.instructions) {
      auto result = instruction(step, tape, registers);
      if (!result) return std::nullopt;
      registers[step.out] = *result;
    }
    return ProjectiveFormula{composer_.expression(registers[0].regular, f.text()), unknowns_};
  }

 private:
  std::optional<Grown> instruction(const Instruction& step, const Tape& tape, const std::vector<Grown>& r) {
    if (step.operation == Operation::constant) return number(tape.constants[step.a]);
    if (step.operation == Operation::variable) return coordinate(step.a);
    return applied(step.operation, r[step.a], info(step.operation).operands == 2 ? r[step.b] : Grown{});
  }

  Grown number(double value) { return {composer_.constant(value), 0.0, value, value >= 0.0}; }

  Grown coordinate(std::size_t index) {
    if (index >= 3) return {composer_.variable(t), 0.0, {}};
    if (static_cast<int>(index) == axis_) return {composer_.constant(side_), 1.0, {}};
    const bool is_first = static_cast<int>(index) == (axis_ + 1) % 3;
    return {composer_.variable(is_first ? first : second), 1.0, {}};
  }

  std::optional<Grown> applied(Operation operation, const Grown& a, const Grown& b) {
    switch (operation) {
      case Operation::min:
        if (const auto cut = cut_off(a, b)) return cut;
        if (const auto cut = cut_off(b, a)) return cut;
        [[fallthrough]];
      case Operation::add:
      case Operation::subtract:
      case Operation::max: {
        const double degree = std::max(a.degree, b.degree);
        return Grown{composer_.apply(operation, of_degree(a, degree), of_degree(b, degree)), degree, {}};
      }
      case Operation::multiply:
        return Grown{composer_.apply(operation, a.regular, b.regular),
                     a.degree + b.degree,
                     {},
                     a.never_negative && b.never_negative};
      case Operation::divide:
        return Grown{composer_.apply(operation, a.regular, b.regular),
                     a.degree - b.degree,
                     {},
                     a.never_negative && b.never_negative};
      case Operation::negate:
        return Grown{composer_.apply(operation, a.regular), a.degree, {}};
      case Operation::abs:
        return Grown{composer_.apply(operation, a.regular), a.degree, {}, true};
      case Operation::square:
        return Grown{composer_.apply(operation, a.regular), 2.0 * a.degree, {}, true};
      case Operation::sqrt:
        return Grown{composer_.apply(operation, a.regular), a.degree / 2.0, {}, true};
      case Operation::cbrt:
        return Grown{composer_.apply(operation, a.regular), a.degree / 3.0, {}};
      case Operation::integer_power:
      case Operation::pow:
        if (!b.constant) break;
        return Grown{composer_.apply(operation, a.regular, b.regular), a.degree * *b.constant, {}};
      default:
        break;
    }
    if (a.degree <= 0.0 && b.degree <= 0.0) {
      return Grown{composer_.apply(operation, of_degree(a, 0.0), of_degree(b, 0.0)), 0.0, {}};
    }
    return bounded(operation, a, b);
  }

  /// min(grown, limit) of something that is never negative and a constant: between 0 and the constant.
  std::optional<Grown> cut_off(const Grown& grown, const Grown& limit) {
    if (!limit.constant || !(*limit.constant >= 0.0) || !grown.never_negative || grown.degree <= 0.0)
      return {};
    if (unknowns_ >= most_unknowns) return {};
    return unknown(0.5 * *limit.constant, 0.5 * *limit.constant);
  }

  /// What stays within bounds however its operand grows: anything within them.
  std::optional<Grown> bounded(Operation operation, const Grown& a, const Grown& b) {
    if (unknowns_ >= most_unknowns) return std::nullopt;
    switch (operation) {
      case Operation::sin:
      case Operation::cos:
      case Operation::tanh:
        return unknown(0.0, 1.0);
      case Operation::atan:
        return unknown(0.0, 0.5 * std::numbers::pi * (1.0 + 1e-15));
      case Operation::atan2:
        return unknown(0.0, std::numbers::pi * (1.0 + 1e-15));
      case Operation::floor:  // within 1 of what it is of
        return applied(Operation::add, a, unknown(0.0, 1.0));
      case Operation::mod:
        if (!b.constant) return std::nullopt;
        return unknown(0.0, std::abs(*b.constant));
      default:
        return std::nullopt;
    }
  }

  Grown unknown(double middle, double half) {
    const Composer::Node node = composer_.variable(first_unknown + unknowns_++);
    const Composer::Node scaled = composer_.apply(Operation::multiply, composer_.constant(half), node);
    return {composer_.apply(Operation::add, composer_.constant(middle), scaled), 0.0, {}};
  }

  /// The same as s^degree · (something regular), degree not less than its own.
  Composer::Node of_degree(const Grown& grown, double degree) {
    const double more = degree - grown.degree;
    if (more == 0.0) return grown.regular;
    const Composer::Node shrinking = composer_.power(composer_.variable(w), composer_.constant(more));
    return composer_.apply(Operation::multiply, grown.regular, shrinking);
  }

  Composer composer_;
  int axis_;
  double side_;
  std::size_t unknowns_ = 0;
};

}  // namespace

std::optional<ProjectiveFormula> seen_from_infinity(const Expression& f, int axis, double side) {
  return Homogenizer(axis, side).of(f);
}

}  // namespace backlight
