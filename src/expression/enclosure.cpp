// Compiled with -frounding-math.
#include "backlight/expression/enclosure.h"

#include <array>
#include <vector>

#include "bounds.h"
#include "rounding.h"

namespace backlight {

/// A value and its derivative along the line.
using BoundsSlope = Derivatives<Bounds, 1>;

/// Of min and max: the slope of the operand that is chosen, or, where that may be either, the slopes of both.
/// `first` holds 1 where `a` may be chosen and 0 where it may not be.
Bounds slope_of_choice(const Bounds& first, const Bounds& a, const Bounds& b) {
  if (first.is_undefined() || worse(a, b) == Continuity::undefined) return nowhere();
  if (first.minus_lower < 0.0) return a;
  if (first.upper == 0.0) return b;
  return {std::max(a.minus_lower, b.minus_lower), std::max(a.upper, b.upper), worse(a, b)};
}

template <>
BoundsSlope apply<BoundsSlope>(Operation operation, const BoundsSlope& a, const BoundsSlope& b) {
  if (operation != Operation::min && operation != Operation::max) return differentiate(operation, a, b);
  const Bounds first =
      operation == Operation::min ? slope_of_minimum(a.value, b.value) : slope_of_maximum(a.value, b.value);
  return {apply<Bounds>(operation, a.value, b.value), {slope_of_choice(first, a.partial[0], b.partial[0])}};
}

namespace {

/// Room on the stack, by size: a number here is not free to make.
constexpr std::size_t few = 8;
constexpr std::size_t many = 64;

template <class N, std::size_t count>
N run_on_stack(const Tape& tape, std::span<const N> variables) {
  std::array<N, count> registers;
  return run<N>(tape, variables, registers);
}

/// Not inlined: its arithmetic must not move past the change of rounding mode in its callers.
template <class N>
[[gnu::noinline]] N run_rounded(const Tape& tape, std::span<const N> variables) {
  if (tape.registers <= few) return run_on_stack<N, few>(tape, variables);
  if (tape.registers <= many) return run_on_stack<N, many>(tape, variables);
  std::vector<N> registers(tape.registers);
  return run<N>(tape, variables, registers);
}

/// Calls `use` with `count` numbers made by `make`.
template <class N, class Make>
[[gnu::noinline]] N run_with(const Tape& tape, std::size_t count, const Make& make) {
  if (count <= few) {
    std::array<N, few> variables;
    for (std::size_t i = 0; i < count; ++i) variables[i] = make(i);
    return run_rounded<N>(tape, std::span<const N>(variables.data(), count));
  }
  std::vector<N> variables(count);
  for (std::size_t i = 0; i < count; ++i) variables[i] = make(i);
  return run_rounded<N>(tape, variables);
}

/// A number that is not known to be anything.
Interval unknown_if_undefined(const Interval& slope) {
  return slope.continuity == Continuity::undefined ? Interval{-infinity, infinity, Continuity::partial}
                                                   : slope;
}

}  // namespace

Interval enclose(const Tape& tape, std::span<const Interval> variables) {
  const RoundUp mode;
  return run_with<Bounds>(tape, variables.size(), [&](std::size_t i) { return Bounds(variables[i]); })
      .interval();
}

Interval enclose(const Tape& tape, const VariableLine& line, double s) {
  const RoundUp mode;
  return run_with<Bounds>(
             tape, line.origin.size(),
             [&](std::size_t i) { return Bounds(line.origin[i]) + Bounds(line.direction[i]) * Bounds(s); })
      .interval();
}

IntervalSlope enclose(const Tape& tape, const VariableLine& line, double from, double to) {
  const RoundUp mode;
  const BoundsSlope result = run_with<BoundsSlope>(tape, line.origin.size(), [&](std::size_t i) {
    const Bounds slope(line.direction[i]);
    const Bounds value = Bounds(line.origin[i]) + slope * Bounds(-from, to, Continuity::continuous);
    return BoundsSlope(value, {slope});
  });
  return {result.value.interval(), unknown_if_undefined(result.partial[0].interval())};
}

}  // namespace backlight
