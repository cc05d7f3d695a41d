// Numbers written as text: "2*t + sin(pi*t)".
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

#include "backlight/expression/dual.h"
#include "backlight/expression/tape.h"

namespace backlight {

class Composer;

/// Why a text is not an expression. The column counts from 1 within the text, in characters (UTF-8 code
/// points), and `length` is in characters too: the caret of a diagnostic.
struct ExpressionError {
  int column = 1;
  int length = 1;
  std::string message;
  std::string hint;  ///< what to write instead; may be empty
};

/// The names of an expression's variables, in order. Made once for all expressions of a scene, whose
/// parameters may be many: a name is then found at once.
class VariableNames {
 public:
  VariableNames(std::vector<std::string> names);
  VariableNames(std::initializer_list<std::string> names) : VariableNames(std::vector<std::string>(names)) {}

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// The index of a name (of several equal ones the first), or nothing.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const;

 private:
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::size_t> index_of_;
};

/// A formula in named variables. Immutable, cheap to copy, and safe to use from many threads at once.
///
///     sum     = product { ("+" | "-") product }
///     product = signed { ("*" | "/") signed }
///     signed  = { "+" | "-" } power
///     power   = value [ "^" signed ]              right-associative: -2^2 = -4, 2^3^2 = 512
///     value   = number | name | function "(" sum { "," sum } ")" | "(" sum ")"
///
/// The functions are C's sin cos tan asin acos atan atan2 sinh cosh tanh exp log sqrt cbrt abs floor pow (in
/// radians), min and max of two or more, mod(a, b) = a - b floor(a/b), clamp(x, low, high); the constants pi
/// and e.
///
/// Outside a function's domain the value is NaN (and NaN stays NaN through min, max and clamp); a division by
/// zero or an overflow is infinite. Neither is an error here: callers check with std::isfinite.
class Expression {
 public:
  /// A text longer than this, in bytes, is refused.
  static constexpr std::size_t longest_text = 65536;
  /// Parentheses, signs and powers nested deeper than this are refused.
  static constexpr int deepest_nesting = 200;

  /// The constant 0.
  Expression();

  /// Compiles `text`. A name of the language (is_expression_name) is never looked up in `variables`.
  static std::variant<Expression, ExpressionError> parse(std::string_view text,
                                                         const VariableNames& variables);

  /// The value for variables in the order they were given to parse().
  /// Throws std::invalid_argument when `values` is too short. Allocates only beyond 64 live intermediate
  /// values.
  [[nodiscard]] double evaluate(std::span<const double> values) const;

  /// The value, and its derivative when each variable changes at the rate of its own `derivative`.
  [[nodiscard]] Dual evaluate(std::span<const Dual> values) const;

  /// The value and its gradient; give each variable its own rates of change.
  [[nodiscard]] Gradient evaluate(std::span<const Gradient> values) const;

  /// How many variables it was parsed with.
  [[nodiscard]] std::size_t variables() const;

  /// The same formula with numbers in the place of its last variables, those from `first` on. Takes
  /// (variables - first) values; throws std::invalid_argument when they are fewer. What depends on them alone
  /// is folded into constants, and a whole exponent among them gets the treatment of a written one.
  [[nodiscard]] Expression bind(std::size_t first, std::span<const double> values) const;

  /// Whether the value depends on the variable of this index.
  [[nodiscard]] bool uses(std::size_t variable) const;
  /// The indices of all variables that the value depends on, each once, in rising order.
  [[nodiscard]] std::vector<std::size_t> used_variables() const;

  /// The value, when it depends on no variable. May be NaN or infinite, as in "1/0".
  [[nodiscard]] std::optional<double> constant() const;

  /// The text as written.
  [[nodiscard]] const std::string& text() const;

  /// The program, for evaluation with other number types: run() of tape.h.
  [[nodiscard]] const Tape& tape() const;

 private:
  friend class Composer;
  struct Compiled;
  static Expression from_tape(std::string text, Tape tape, std::size_t variables);
  explicit Expression(std::shared_ptr<const Compiled> compiled);

  std::shared_ptr<const Compiled> compiled_;
};

/// Whether `name` means something in every expression: a function, or pi or e. No variable may be called so.
bool is_expression_name(std::string_view name);

}  // namespace backlight
