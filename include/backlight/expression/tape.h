// The compiled form of an expression, and its one evaluator for every number type.
#pragma once

#include <algorithm>
#include <array>
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

/// A straight-line program. The value is in register 0 after the last instruction; of several values, those
/// beyond the first are in the registers 1, 2 ... `out` may be the same register as an operand: operands are
/// read before the result is written.
struct Tape {
  std::vector<Instruction> instructions;
  std::vector<double> constants;
  std::size_t registers = 1;
};

/// One operation on numbers of type N. N is made from a double by N(x), has + - * /, and the functions of the
/// table found by argument-dependent lookup (square, minimum, maximum and modulo among them).
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

/// The partial derivatives of an operation.
template <class N>
struct Slopes {
  N along_a;
  N along_b;
};

/// The partial derivatives of `operation` at (a, b), where its value is v. One that is not wanted is 0: an
/// operand that does not change contributes nothing to a derivative, even where the slope along it is not
/// finite. x^35 has no slope along its exponent at x < 0, and needs none.
template <class N>
Slopes<N> slopes(Operation operation, const N& a, [[maybe_unused]] const N& b, [[maybe_unused]] const N& v,
                 bool wanted_a, bool wanted_b) {
  using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cbrt, std::cos, std::cosh, std::exp,
      std::floor, std::log, std::pow, std::sin, std::sinh, std::sqrt, std::tan, std::tanh;
  switch (operation) {
#define BACKLIGHT_CASE(identifier, name, operands, value, da, db) \
  case Operation::identifier:                                     \
    return {wanted_a ? N(da) : N(0.0), operands == 2 && wanted_b ? N(db) : N(0.0)};
    BACKLIGHT_OPERATIONS(BACKLIGHT_CASE)
#undef BACKLIGHT_CASE
    case Operation::constant:
    case Operation::variable:
      break;
  }
  return {N(0.0), N(0.0)};
}

/// The chain rule, for a value with any number of partial derivatives.
template <class N, int count>
struct Derivatives {
  N value{0.0};
  std::array<N, count> partial{};

  Derivatives() = default;
  explicit Derivatives(double constant) : value(constant) { partial.fill(N(0.0)); }
  Derivatives(const N& v, const std::array<N, count>& p) : value(v), partial(p) {}

  [[nodiscard]] bool changes() const {
    return std::any_of(partial.begin(), partial.end(), [](const N& p) { return p != N(0.0); });
  }
};

template <class N, int count>
Derivatives<N, count> differentiate(Operation operation, const Derivatives<N, count>& a,
                                    const Derivatives<N, count>& b) {
  Derivatives<N, count> result(apply<N>(operation, a.value, b.value), {});
  const bool a_changes = a.changes();
  const bool b_changes = b.changes();
  const Slopes<N> slope = slopes<N>(operation, a.value, b.value, result.value, a_changes, b_changes);
  for (std::size_t i = 0; i < count; ++i) {
    N sum(0.0);
    if (a.partial[i] != N(0.0)) sum = sum + slope.along_a * a.partial[i];
    if (b.partial[i] != N(0.0) && info(operation).operands == 2) sum = sum + slope.along_b * b.partial[i];
    result.partial[i] = sum;
  }
  return result;
}

/// A value with its gradient in space, for normals.
using Gradient = Derivatives<double, 3>;

template <>
inline Gradient apply<Gradient>(Operation operation, const Gradient& a, const Gradient& b) {
  return differentiate(operation, a, b);
}

template <>
inline Dual apply<Dual>(Operation operation, const Dual& a, const Dual& b) {
  const auto result =
      differentiate<double, 1>(operation, {a.value, {a.derivative}}, {b.value, {b.derivative}});
  return {result.value, result.partial[0]};
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
