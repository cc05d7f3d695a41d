// The check of numbers and arrays of them. Strings become expressions here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "backlight/base/diagnostics.h"
#include "backlight/scene/description.h"
#include "backlight/scene/keys.h"

namespace backlight {

/// Checks values against the forms of numbers. What is wrong is reported and becomes Invalid.
class NumberCheck {
 public:
  /// The description's variables are those of every expression.
  NumberCheck(const Description& description, Diagnostics& diagnostics)
      : description_(description),
        diagnostics_(diagnostics),
        variables_(description.variables),
        used_(description.variables.size(), false) {}

  void number(Node& node, const Key& key);
  void numbers(Node& node, const Key& key, const ValueForm& form);
  /// Colours or points.
  void triples(Node& node, const Key& key, const ValueForm& form);
  /// An expression of x, y, z and the description's variables, in this order (formula_variables).
  void formula(Node& node);
  /// An array of them, numbers among them.
  void formulas(Node& node, const Key& key, const ValueForm& form);

  /// For each variable, whether any expression so far uses it.
  [[nodiscard]] const std::vector<bool>& used() const { return used_; }

 private:
  void parse(Node& node, const VariableNames& variables, std::size_t first);
  void error(const Place& place, std::string message, std::string hint = {});
  void expression_error(const Node& node, const ExpressionError& wrong);

  const Description& description_;
  Diagnostics& diagnostics_;
  VariableNames variables_;
  std::optional<VariableNames> of_surfaces_;  // made for the first formula
  std::vector<bool> used_;
  std::size_t wrong_expressions_ = 0;
};

}  // namespace backlight
