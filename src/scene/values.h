// A description's tables, read with their expressions evaluated for one image.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "backlight/base/diagnostics.h"
#include "backlight/base/vector.h"
#include "backlight/scene/description.h"
#include "backlight/scene/keys.h"

namespace backlight {

/// The values of the variables of one image, and where complaints go.
struct ImageValues {
  const Description& description;
  std::vector<double> variables;  ///< by index into Description::variables
  Diagnostics& diagnostics;
  std::vector<Dual> rates = {};  ///< the same with their derivatives by t; empty where nothing can move
  std::unordered_set<std::size_t> wrong_variables = {};  ///< parameters that are no numbers: reported, and 0

  /// What is made of them is not complained about besides.
  [[nodiscard]] bool uses_wrong_variable(const Expression& expression) const {
    if (wrong_variables.empty()) return false;
    const std::vector<std::size_t> used = expression.used_variables();
    return std::any_of(used.begin(), used.end(),
                       [&](std::size_t variable) { return wrong_variables.count(variable) > 0; });
  }

  void error(const Place& place, std::string message, std::string hint = {}) {
    diagnostics.error(description.span(place), std::move(message), std::move(hint));
  }
};

/// One table with its keys. Values that are not written are their defaults; a value that is not finite or out
/// of its key's range is reported, and read as the default too. A key that the table of keys does not have is
/// a mistake of the program: std::logic_error.
class TableView {
 public:
  /// `node` may be null or invalid: all values are then defaults.
  TableView(ImageValues& values, const Node* node, const KeyTable& keys);

  /// The table of a key at the top of the file.
  static TableView top(ImageValues& values, std::string_view name);

  /// Whether the key is written (its value may have been wrong, and reported).
  [[nodiscard]] bool has(std::string_view key) const { return node_of(key) != nullptr; }
  /// Whether the key is written and its value was right so far.
  [[nodiscard]] bool has_valid(std::string_view key) const;
  /// Whether nothing within the key's value has been wrong so far; true of a default.
  [[nodiscard]] bool is_sound(std::string_view key) const;
  /// The table as written, or null.
  [[nodiscard]] const Node* node() const { return node_; }
  /// The written value, or null.
  [[nodiscard]] const Node* node_of(std::string_view key) const;
  /// Where the key's value stands, or the table if it is not written.
  [[nodiscard]] Place place(std::string_view key) const;
  [[nodiscard]] Place place() const { return node_ != nullptr ? node_->place : Place{}; }

  [[nodiscard]] double number(std::string_view key) const;
  /// The number if it is written.
  [[nodiscard]] std::optional<double> optional_number(std::string_view key) const;
  /// A vector: zero if it has no default.
  [[nodiscard]] Vec3 vector(std::string_view key) const;
  [[nodiscard]] std::vector<double> numbers(std::string_view key) const;
  /// The number, or the vector's components, with the derivatives by t. Exact: formulas are differentiated.
  /// What was wrong with the value has been reported by number() or vector(), and is the default.
  [[nodiscard]] Dual moving_number(std::string_view key) const;
  [[nodiscard]] std::array<Dual, 3> moving_vector(std::string_view key) const;

  /// Of a key whose `t` is the thing's own time: its number as a formula of `t` alone, if it depends on `t`.
  [[nodiscard]] std::optional<Expression> in_own_time(std::string_view key) const;
  /// The same of a vector, of which any component depends on `t`; the others are constants, and checked.
  [[nodiscard]] std::optional<std::array<Expression, 3>> vector_in_own_time(std::string_view key) const;
  /// The same of element `index` of an array of vectors.
  [[nodiscard]] std::optional<std::array<Expression, 3>> vector_in_own_time(std::string_view key,
                                                                            std::size_t index) const;

  /// Element `index` of an array of three numbers each.
  [[nodiscard]] Vec3 vector_at(std::string_view key, std::size_t index) const;
  [[nodiscard]] bool boolean(std::string_view key) const;
  /// A string: empty if it has no default.
  [[nodiscard]] std::string text(std::string_view key) const;
  /// A table within this one; `keys` is its table's name.
  [[nodiscard]] TableView table(std::string_view key, std::string_view keys) const;

  /// Whether all required keys are there and have been right so far.
  [[nodiscard]] bool complete() const;

  /// Of several keys that exclude each other, the one that is written; empty if none is. Two are an error.
  [[nodiscard]] std::string_view one_of(const std::vector<std::string_view>& keys) const;

  void error(std::string_view key, std::string message, std::string hint = {}) const;
  void warning(std::string_view key, std::string message, std::string hint = {}) const;
  [[nodiscard]] ImageValues& values() const { return *values_; }

 private:
  [[nodiscard]] const Key& key(std::string_view name) const;
  [[nodiscard]] std::optional<double> evaluated(const Node& node, const Key& key) const;
  [[nodiscard]] std::vector<double> numbers_of(const Node* node, const Key& key) const;
  [[nodiscard]] Dual moving(const Node* node, double value) const;
  [[nodiscard]] std::optional<Expression> own_formula(const Node& node) const;
  [[nodiscard]] std::optional<std::array<Expression, 3>> own_formulas(const Node* node, const Key& key) const;
  [[nodiscard]] std::vector<double> default_numbers(const Key& key) const;

  ImageValues* values_;
  const Node* node_;
  const KeyTable* keys_;
  const KeyTable* variant_ = nullptr;
};

}  // namespace backlight
