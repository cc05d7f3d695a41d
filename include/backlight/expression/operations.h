// The one table of what an expression may compute. To add an operation, add a row here: the parser, the
// evaluators for every number type, the derivatives and the error hints all read this table.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace backlight {

/// a². Exact where a product of two independent factors would not be (an interval's square is never
/// negative).
inline double square(double a) {
  return a * a;
}

/// The smaller of two; NaN if either is NaN, unlike std::fmin, so that a domain error is never hidden.
inline double minimum(double a, double b) {
  return std::isnan(a) || a < b ? a : b;
}

/// The larger of two; NaN if either is NaN.
inline double maximum(double a, double b) {
  return std::isnan(a) || a > b ? a : b;
}

/// a - b floor(a/b): the remainder with the sign of b, so mod(-1, 3) = 2. NaN for b = 0.
inline double modulo(double a, double b) {
  return a - b * std::floor(a / b);
}

/// aⁿ for a whole n >= 1, by squaring and multiplying from the highest bit down: x^5 = ((x²)²) x. About log2
/// n multiplications, defined for every a, and within n ulp of the exact value.
inline double integer_power(double a, double n) {
  const auto bits = static_cast<unsigned>(n);
  double result = a;
  for (int bit = static_cast<int>(std::bit_width(bits)) - 2; bit >= 0; --bit) {
    result *= result;
    if ((bits >> bit & 1U) != 0) result *= a;
  }
  return result;
}

/// The slope of |a|: -1, 1, and 0 at the kink.
inline double sign(double a) {
  return a > 0 ? 1.0 : a < 0 ? -1.0 : 0.0;
}

/// The slope of min(a, b) or max(a, b) along the operand `a`: 1 where it is the one chosen, else 0.
inline double slope_of_minimum(double a, double b) {
  return minimum(a, b) == a ? 1.0 : 0.0;
}
inline double slope_of_maximum(double a, double b) {
  return maximum(a, b) == a ? 1.0 : 0.0;
}

/// The slope of v = aᵇ along b.
inline double slope_of_exponent(double a, double v) {
  return a == 0.0 ? 0.0 : v * std::log(a);
}

// X(identifier, function name, operands, value, d value/da, d value/db)
//   function name: how it is called in a text; empty when it is an operator or is made by the parser alone
//   value:         in terms of the operands a and b, of any number type N
//   derivatives:   in terms of a, b and the value v, of any number type N
//
// So an operation is written once for numbers, intervals, SIMD lanes and the derivatives of each. A number
// type that lacks one of the functions named here does not compile.
//
// min and max of more than two arguments are chains of these; clamp(x, low, high) is min(max(x, low), high).
#define BACKLIGHT_OPERATIONS(X)                                                                \
  X(add, "", 2, a + b, N(1.0), N(1.0))                                                         \
  X(subtract, "", 2, a - b, N(1.0), N(-1.0))                                                   \
  X(multiply, "", 2, a* b, b, a)                                                               \
  X(divide, "", 2, a / b, N(1.0) / b, -v / b)                                                  \
  X(negate, "", 1, -a, N(-1.0), N(0.0))                                                        \
  X(square, "", 1, square(a), N(2.0) * a, N(0.0))                                              \
  X(integer_power, "", 2, integer_power(a, b), b* integer_power(a, b - N(1.0)), N(0.0))        \
  X(sin, "sin", 1, sin(a), cos(a), N(0.0))                                                     \
  X(cos, "cos", 1, cos(a), -sin(a), N(0.0))                                                    \
  X(tan, "tan", 1, tan(a), N(1.0) + square(v), N(0.0))                                         \
  X(asin, "asin", 1, asin(a), N(1.0) / sqrt((N(1.0) - a) * (N(1.0) + a)), N(0.0))              \
  X(acos, "acos", 1, acos(a), N(-1.0) / sqrt((N(1.0) - a) * (N(1.0) + a)), N(0.0))             \
  X(atan, "atan", 1, atan(a), N(1.0) / (N(1.0) + square(a)), N(0.0))                           \
  X(atan2, "atan2", 2, atan2(a, b), b / (square(a) + square(b)), -a / (square(a) + square(b))) \
  X(sinh, "sinh", 1, sinh(a), cosh(a), N(0.0))                                                 \
  X(cosh, "cosh", 1, cosh(a), sinh(a), N(0.0))                                                 \
  X(tanh, "tanh", 1, tanh(a), N(1.0) / square(cosh(a)), N(0.0))                                \
  X(exp, "exp", 1, exp(a), v, N(0.0))                                                          \
  X(log, "log", 1, log(a), N(1.0) / a, N(0.0))                                                 \
  X(sqrt, "sqrt", 1, sqrt(a), N(0.5) / v, N(0.0))                                              \
  X(cbrt, "cbrt", 1, cbrt(a), N(1.0) / (N(3.0) * square(v)), N(0.0))                           \
  X(abs, "abs", 1, abs(a), sign(a), N(0.0))                                                    \
  X(floor, "floor", 1, floor(a), N(0.0), N(0.0))                                               \
  X(min, "min", 2, minimum(a, b), slope_of_minimum(a, b), N(1.0) - slope_of_minimum(a, b))     \
  X(max, "max", 2, maximum(a, b), slope_of_maximum(a, b), N(1.0) - slope_of_maximum(a, b))     \
  X(pow, "pow", 2, pow(a, b), b* pow(a, b - N(1.0)), slope_of_exponent(a, v))                  \
  X(mod, "mod", 2, modulo(a, b), N(1.0), -floor(a / b))

/// What one node of an expression computes. The first two have no operands: they name where a value is from.
enum class Operation : std::uint8_t {
  constant,
  variable,
#define BACKLIGHT_ENUMERATOR(identifier, name, operands, value, da, db) identifier,
  BACKLIGHT_OPERATIONS(BACKLIGHT_ENUMERATOR)
#undef BACKLIGHT_ENUMERATOR
};

struct OperationInfo {
  Operation operation;
  std::string_view function_name;  ///< empty: not callable by name
  int operands;                    ///< 1 or 2
};

inline constexpr auto operation_table = std::to_array<OperationInfo>({
#define BACKLIGHT_ROW(identifier, name, operands, value, da, db) {Operation::identifier, name, operands},
    BACKLIGHT_OPERATIONS(BACKLIGHT_ROW)
#undef BACKLIGHT_ROW
});

/// The row of an operation other than `constant` and `variable`.
constexpr const OperationInfo& info(Operation operation) {
  return operation_table[static_cast<std::size_t>(operation) - 2];
}

}  // namespace backlight
