// How formulas depend on a variable that goes on and on: by waves, and in proportion.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "backlight/expression/waves.h"

namespace backlight {
namespace {

/// What is known of a value. Its rate of change has the periods of waves of these rates.
struct Dependence {
  bool is_known = true;
  bool drifts = false;  ///< something is added to waves that is proportional to the variable
  std::vector<double> rates;
  std::optional<double> slope;  ///< of a value that is number + slope · variable
  bool is_number = false;       ///< then `number` is all
  double number = 0.0;

  [[nodiscard]] bool is_steady() const { return is_known && !drifts && rates.empty(); }
};

Dependence unknown() {
  return {.is_known = false};
}

void add_rates(Dependence& a, const Dependence& b) {
  for (const double rate : b.rates) {
    if (std::ranges::find(a.rates, rate) == a.rates.end()) a.rates.push_back(rate);
  }
}

Dependence sum(Operation operation, const Dependence& a, const Dependence& b) {
  Dependence result = a;
  result.drifts = a.drifts || b.drifts;
  add_rates(result, b);
  const double sign = operation == Operation::add ? 1.0 : -1.0;
  result.slope = a.slope && b.slope ? std::optional(*a.slope + sign * *b.slope) : std::nullopt;
  result.is_number = a.is_number && b.is_number;
  result.number = a.number + sign * b.number;
  return result;
}

/// a b, or a/b.
Dependence product(Operation operation, const Dependence& a, const Dependence& b) {
  const bool divides = operation == Operation::divide;
  if ((a.drifts && !b.is_steady()) || (b.drifts && (divides || !a.is_steady()))) return unknown();
  Dependence result;
  result.drifts = a.drifts || b.drifts;
  add_rates(result, a);
  add_rates(result, b);
  if (b.is_number && a.slope) result.slope = divides ? *a.slope / b.number : *a.slope * b.number;
  if (a.is_number && b.slope && !divides) result.slope = a.number * *b.slope;
  result.is_number = a.is_number && b.is_number;
  result.number = divides ? a.number / b.number : a.number * b.number;
  return result;
}

Dependence wave(const Dependence& angle) {
  if (!angle.drifts) return {.rates = angle.rates};
  if (!angle.slope) return unknown();
  return {.rates = {std::abs(*angle.slope)}};
}

Dependence applied(Operation operation, const Dependence& a, const Dependence& b) {
  if (!a.is_known || !b.is_known) return unknown();
  switch (operation) {
    case Operation::add:
    case Operation::subtract:
      return sum(operation, a, b);
    case Operation::negate:
      return sum(Operation::subtract, {.slope = 0.0, .is_number = true}, a);
    case Operation::multiply:
    case Operation::divide:
      return product(operation, a, b);
    case Operation::sin:
    case Operation::cos:
      return wave(a);
    default: {
      if (a.drifts || b.drifts) return unknown();
      Dependence result{.rates = a.rates};
      add_rates(result, b);
      return result;
    }
  }
}

Dependence dependence(const Expression& formula, std::size_t variable) {
  const Tape& tape = formula.tape();
  std::vector<Dependence> registers(tape.registers);
  for (const Instruction& step : tape.instructions) {
    Dependence& out = registers[step.out];
    if (step.operation == Operation::constant) {
      out = {.slope = 0.0, .is_number = true, .number = tape.constants[step.a]};
    } else if (step.operation == Operation::variable) {
      out = step.a == variable ? Dependence{.drifts = true, .slope = 1.0} : Dependence{};
    } else {
      const bool has_two = info(step.operation).operands == 2;
      out = applied(step.operation, registers[step.a], has_two ? registers[step.b] : Dependence{});
    }
  }
  return registers[0];
}

}  // namespace

std::optional<double> period_of_rates(std::span<const Expression> formulas, std::size_t variable) {
  Dependence all;
  for (const Expression& formula : formulas) {
    const Dependence its = dependence(formula, variable);
    if (!its.is_known) return std::nullopt;
    add_rates(all, its);
  }
  std::erase(all.rates, 0.0);
  if (all.rates.empty()) return std::nullopt;
  // The slowest goes round `turns` times while each of the others does so a whole number of times, to the
  // rounding of their quotient.
  const double slowest = std::ranges::min(all.rates);
  constexpr int most_turns = 12;
  for (int turns = 1; turns <= most_turns; ++turns) {
    const bool all_whole = std::ranges::all_of(all.rates, [&](double rate) {
      const double times = rate / slowest * turns;
      return std::abs(times - std::round(times)) <= 4e-16 * times;
    });
    if (all_whole && std::isfinite(turns / slowest)) return 2.0 * std::numbers::pi * turns / slowest;
  }
  return std::nullopt;
}

}  // namespace backlight
