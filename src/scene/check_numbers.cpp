#include "check_numbers.h"

#include <algorithm>
#include <utility>

#include "value_forms.h"
#include "words.h"

namespace backlight {

void NumberCheck::error(const Place& place, std::string message, std::string hint) {
  diagnostics_.error(description_.span(place), std::move(message), std::move(hint));
}

void NumberCheck::number(Node& node, const Key& key) {
  if (std::holds_alternative<double>(node.value)) return;
  const std::string* text = node.text();
  if (text == nullptr) {
    error(node.place,
          "'" + std::string(key.name) + "' must be made of numbers, and this is " + kind_words(node));
    node.value = Invalid{};
    return;
  }
  parse(node, variables_, 0);
}

void NumberCheck::formula(Node& node) {
  if (!of_surfaces_) of_surfaces_.emplace(formula_variables(description_));
  parse(node, *of_surfaces_, formula_coordinates);
}

void NumberCheck::formulas(Node& node, const Key& key, const ValueForm& form) {
  if (node.array()->size() != static_cast<std::size_t>(form.count)) {
    error(node.place, "'" + std::string(key.name) + "' must be " + form_words(form) + ", not " +
                          std::to_string(node.array()->size()));
    node.value = Invalid{};
    return;
  }
  for (Node& element : *node.array()) {
    if (std::holds_alternative<double>(element.value)) continue;
    if (element.text() != nullptr) {
      formula(element);
      continue;
    }
    error(element.place,
          "'" + std::string(key.name) + "' must be made of formulas, and this is " + kind_words(element));
    element.value = Invalid{};
  }
}

/// Makes the node's text an expression of `variables`, of which those from `first` on are the description's.
void NumberCheck::parse(Node& node, const VariableNames& variables, std::size_t first) {
  // To look for the nearest name takes as long as there are names.
  constexpr std::size_t most_wrong = 200;
  if (wrong_expressions_ > most_wrong) {
    node.value = Invalid{};
    return;
  }
  auto parsed = Expression::parse(*node.text(), variables);
  if (const auto* wrong = std::get_if<ExpressionError>(&parsed)) {
    expression_error(node, *wrong);
    if (++wrong_expressions_ > most_wrong)
      error(node.place, "too many mistakes: the expressions after this one are not looked at");
    node.value = Invalid{};
    return;
  }
  Expression expression = std::get<Expression>(std::move(parsed));
  for (const std::size_t i : expression.used_variables()) {
    if (i >= first) used_[i - first] = true;
  }
  node.value = std::move(expression);
}

// The caret goes to the place within the string, where the string is written as it reads.
void NumberCheck::expression_error(const Node& node, const ExpressionError& wrong) {
  Place place = node.place;
  const std::string& text = *node.text();
  const bool ascii = std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c < 127; });
  const bool plain = ascii && text.find_first_of("\\\"") == std::string::npos;
  if (plain && place.length == text.size() + 2) {
    place.column += static_cast<std::uint32_t>(wrong.column);
    place.length = static_cast<std::uint32_t>(std::max(1, wrong.length));
  } else if (place.length == text.size()) {  // an override without quotes
    place.column += static_cast<std::uint32_t>(wrong.column - 1);
    place.length = static_cast<std::uint32_t>(std::max(1, wrong.length));
  }
  error(place, wrong.message, wrong.hint);
}

void NumberCheck::numbers(Node& node, const Key& key, const ValueForm& form) {
  const std::size_t size = node.array()->size();
  const bool wrong_size = form.count == 0 ? size == 0 : size != static_cast<std::size_t>(form.count);
  if (wrong_size) {
    error(node.place,
          "'" + std::string(key.name) + "' must be " + form_words(form) + ", not of " + std::to_string(size));
    node.value = Invalid{};
    return;
  }
  for (Node& element : *node.array()) number(element, key);
}

void NumberCheck::triples(Node& node, const Key& key, const ValueForm& form) {
  NodeArray& array = *node.array();
  const bool lists =
      std::all_of(array.begin(), array.end(), [](const Node& n) { return n.array() != nullptr; });
  if (!lists || array.size() != static_cast<std::size_t>(form.count)) {
    error(node.place, "'" + std::string(key.name) + "' must be " + form_words(form) + ", each " +
                          (form.kind == ValueKind::colours ? "[red, green, blue]" : "[x, y, z]"));
    node.value = Invalid{};
    return;
  }
  for (Node& colour : array) numbers(colour, key, {ValueKind::numbers, 3, {}});
}

}  // namespace backlight
