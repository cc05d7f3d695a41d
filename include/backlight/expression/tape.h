// The compiled form of an expression, and its one evaluator for every number type.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "backlight/expression/dual.h"
#include "backlight/expression/operations.h"

namespace backlight {

/// register[out] = operation(register[a], register[b]). For `constant` and `variable`, `a` is an index into
/// the tape's constants or into the caller's variables instead.
struct Instruction {
  Operation operation;
  std::uint32_t out;
  std::uint32_t a;
  std::uint32_t b;
};

/// A straight-line program. The value is in register 0 after the last instruction. `out` may be the same
/// register as an operand: operands are read before the result is written.
struct Tape {
  std::vector<Instruction> instructions;
  std::vector<double> constants;
  std::size_t registers = 1;
};

/// One operation on numbers of type N. N needs + - * /, and the functions of the table found by
/// argument-dependent lookup (square, minimum, maximum and modulo among them).
template <class N>
N apply(Operation operation, const N& a, [[maybe_unused]] const N& b) {
  using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cbrt, std::cos, std::cosh, std::exp,
      std::floor, std::log, std::pow, std::sin, std::sinh, std::sqrt, std::tan, std::tanh;
  switch (operation) {
#define BACKLIGHT_CASE(identifier, name, operands, value, da, db) \
  case Operation::identifier:                                     \
    return value;
    BACKLIGHT_OPERATIONS(BACKLIGHT_CASE)
#undef BACKLIGHT_CASE
    case Operation::constant:
    case Operation::variable:
      break;
  }
  return a;
}

/// The partial derivatives of `operation` at (a, b), where its value is v.
struct Slopes {
  double along_a;
  double along_b;
};
inline Slopes slopes(Operation operation, double a, [[maybe_unused]] double b, [[maybe_unused]] double v) {
  switch (operation) {
#define BACKLIGHT_CASE(identifier, name, operands, value, da, db) \
  case Operation::identifier:                                     \
    return {da, db};
    BACKLIGHT_OPERATIONS(BACKLIGHT_CASE)
#undef BACKLIGHT_CASE
    case Operation::constant:
    case Operation::variable:
      break;
  }
  return {0.0, 0.0};
}

/// The chain rule. An operand that does not change contributes nothing, even where the slope along it is not
/// finite: x^3 has no derivative along its exponent at x < 0, and needs none.
template <>
inline Dual apply<Dual>(Operation operation, const Dual& a, const Dual& b) {
  const double v = apply<double>(operation, a.value, b.value);
  const Slopes slope = slopes(operation, a.value, b.value, v);
  Dual result{v, 0.0};
  if (a.derivative != 0.0) result.derivative += slope.along_a * a.derivative;
  if (info(operation).operands == 2 && b.derivative != 0.0) result.derivative += slope.along_b * b.derivative;
  return result;
}

/// Runs a tape. `variables` holds what the tape's variables index; `registers` is room for at least
/// `tape.registers` numbers, overwritten. Allocates nothing.
template <class N>
N run(const Tape& tape, std::span<const N> variables, std::span<N> registers) {
  for (const Instruction& step : tape.instructions) {
    N& out = registers[step.out];
    switch (step.operation) {
      case Operation::constant:
        out = N{tape.constants[step.a]};
        break;
      case Operation::variable:
        out = variables[step.a];
        break;
      default:
        out = apply<N>(step.operation, registers[step.a], registers[step.b]);
    }
  }
  return registers[0];
}

}  // namespace backlight
