#include "time_dependence.h"

#include <algorithm>

namespace backlight {

TimeDependence::TimeDependence(const Description& description)
    : variable_changes_(description.variables.size(), false) {
  variable_changes_[0] = variable_changes_[1] = true;  // t and frame
  const std::vector<const Entry*> parameters = description.parameters();
  for (const std::size_t i : description.parameter_order) {
    if (parameters[i] != nullptr) variable_changes_[i] = changes(parameters[i]->node);
  }
}

bool TimeDependence::changes(const Expression& expression) const {
  const std::size_t count = variable_changes_.size();
  const bool of_a_surface = expression.variables() == count + formula_coordinates;
  const std::size_t first = of_a_surface ? 1 : 0;  // the surface's t is its own
  const std::size_t shift = of_a_surface ? formula_coordinates : 0;
  return std::ranges::any_of(expression.used_variables(), [&](std::size_t used) {
    return used >= first + shift && variable_changes_[used - shift];
  });
}

bool TimeDependence::changes(const Node& node, std::string_view but_for) const {
  if (const auto* expression = std::get_if<Expression>(&node.value)) return changes(*expression);
  if (const NodeArray* array = node.array()) {
    return std::ranges::any_of(*array, [&](const Node& element) { return changes(element, but_for); });
  }
  const NodeTable* table = node.table();
  return table != nullptr && std::ranges::any_of(*table, [&](const Entry& entry) {
           return entry.name != but_for && changes(entry.node, but_for);
         });
}

}  // namespace backlight
