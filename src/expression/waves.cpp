#include "backlight/expression/waves.h"

#include <cmath>

namespace backlight {
namespace {

using Part = std::optional<WaveSum>;

void add_wave(WaveSum& sum, const WaveSum::Wave& wave) {
  for (WaveSum::Wave& its : sum.waves) {
    if (its.rate != wave.rate) continue;
    its.cosine += wave.cosine;
    its.sine += wave.sine;
    return;
  }
  sum.waves.push_back(wave);
}

/// a + factor b, the factor made from numbers of some size.
Part combined(WaveSum a, const WaveSum& b, double factor, double factor_size) {
  a.size += factor_size * b.size;
  a.growth += factor_size * b.growth;
  a.constant += factor * b.constant;
  a.slope += factor * b.slope;
  for (const WaveSum::Wave& wave : b.waves)
    add_wave(a, {wave.rate, factor * wave.cosine, factor * wave.sine});
  return a;
}

bool is_constant(const Part& part) {
  return part && part->slope == 0.0 && part->waves.empty();
}

Part multiple(const Part& part, const Part& factor) {
  return part && is_constant(factor) ? combined({}, *part, factor->constant, factor->size) : std::nullopt;
}

/// 1/part.
Part inverse(const Part& part) {
  if (!is_constant(part) || part->constant == 0.0) return std::nullopt;
  const double value = 1.0 / part->constant;
  return WaveSum{value, 0.0, {}, value * value * part->size, 0.0};
}

/// sin(a + b v) = sin a cos bv + cos a sin bv, and cos(a + b v) = cos a cos bv - sin a sin bv.
Part wave_of(Operation operation, const Part& angle) {
  if (!angle || !angle->waves.empty()) return std::nullopt;
  const bool is_sine = operation == Operation::sin;
  const double a = angle->constant, rate = std::abs(angle->slope), way = angle->slope < 0.0 ? -1.0 : 1.0;
  const double cosine = is_sine ? std::sin(a) : std::cos(a);
  const double sine = way * (is_sine ? std::cos(a) : -std::sin(a));
  const double size = 1.0 + angle->size;
  if (rate == 0.0) return WaveSum{cosine, 0.0, {}, size, angle->growth};
  return WaveSum{0.0, 0.0, {{rate, cosine, sine}}, size, angle->growth};
}

Part applied(Operation operation, const Part& a, const Part& b) {
  switch (operation) {
    case Operation::add:
      return a && b ? combined(*a, *b, 1.0, 1.0) : std::nullopt;
    case Operation::subtract:
      return a && b ? combined(*a, *b, -1.0, 1.0) : std::nullopt;
    case Operation::negate:
      return a ? combined({}, *a, -1.0, 1.0) : std::nullopt;
    case Operation::multiply:
      return is_constant(a) ? multiple(b, a) : multiple(a, b);
    case Operation::divide:
      return multiple(a, inverse(b));
    case Operation::sin:
    case Operation::cos:
      return wave_of(operation, a);
    default:
      return std::nullopt;
  }
}

bool is_finite(const WaveSum& sum) {
  double all = sum.size + sum.growth;
  for (const WaveSum::Wave& wave : sum.waves) all += wave.rate + std::abs(wave.cosine) + std::abs(wave.sine);
  return std::isfinite(all);
}

}  // namespace

std::optional<WaveSum> wave_sum(const Expression& formula, std::size_t variable) {
  const Tape& tape = formula.tape();
  std::vector<Part> registers(tape.registers);
  for (const Instruction& step : tape.instructions) {
    Part& out = registers[step.out];
    if (step.operation == Operation::constant) {
      const double value = tape.constants[step.a];
      out = WaveSum{value, 0.0, {}, std::abs(value), 0.0};
    } else if (step.operation == Operation::variable) {
      out = step.a == variable ? Part(WaveSum{0.0, 1.0, {}, 0.0, 1.0}) : std::nullopt;
    } else {
      const bool has_two = info(step.operation).operands == 2;
      out = applied(step.operation, registers[step.a], has_two ? registers[step.b] : std::nullopt);
    }
  }
  const Part& sum = registers[0];
  return sum && is_finite(*sum) ? sum : std::nullopt;
}

}  // namespace backlight
