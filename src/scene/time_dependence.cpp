#include "time_dependence.h"

#include <algorithm>

namespace backlight {

TimeDependence::TimeDependence(const Description& description)
    : of_t_(description.follows_t), of_image_(description.variables.size(), false) {
  of_image_[variable_frame] = of_image_[variable_image_time] = true;
  const std::vector<const Entry*> parameters = description.parameters();
  for (const std::size_t i : description.parameter_order) {
    const auto* formula =
        parameters[i] != nullptr ? std::get_if<Expression>(&parameters[i]->node.value) : nullptr;
    of_image_[i] = formula != nullptr && changes(*formula, true);
  }
}

bool TimeDependence::changes(const Expression& expression, bool own_time) const {
  const std::size_t coordinates = expression.variables() - of_t_.size();
  return std::ranges::any_of(expression.used_variables(), [&](std::size_t used) {
    if (used < coordinates) return false;
    const std::size_t variable = used - coordinates;
    return of_image_[variable] || (!own_time && of_t_[variable]);
  });
}

bool TimeDependence::changes(const Node& node, std::string_view but_for) const {
  return changes(node, but_for, false);
}

bool TimeDependence::changes(const Node& node, std::string_view but_for, bool own_time) const {
  if (const auto* expression = std::get_if<Expression>(&node.value)) {
    const bool of_a_surface = expression->variables() > of_t_.size();
    return changes(*expression, own_time || of_a_surface);
  }
  if (const NodeArray* array = node.array()) {
    return std::ranges::any_of(*array,
                               [&](const Node& element) { return changes(element, but_for, own_time); });
  }
  const NodeTable* table = node.table();
  return table != nullptr && std::ranges::any_of(*table, [&](const Entry& entry) {
           return entry.name != but_for && changes(entry.node, but_for, own_time);
         });
}

bool TimeDependence::changes(const Node& table, const KeyTable& keys) const {
  const NodeTable* entries = table.table();
  return entries != nullptr && std::ranges::any_of(*entries, [&](const Entry& entry) {
           const Key* key = find_key(keys, entry.name);
           if (key == nullptr) return changes(entry.node);
           const auto within = std::ranges::find(key->forms, ValueKind::table, &ValueForm::kind);
           if (within != key->forms.end() && entry.node.table() != nullptr)
             return changes(entry.node, *find_table(within->table));
           return changes(entry.node, {}, key->clock == Clock::own);
         });
}

}  // namespace backlight
