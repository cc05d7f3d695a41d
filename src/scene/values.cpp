#include "values.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "own_time.h"
#include "time_dependence.h"

namespace backlight {
namespace {

std::string sentence(const Key& key, double value, const ImageValues& values, const Node& node) {
  std::string text = "'" + std::string(key.name) + "' is " + number_text(value);
  const auto* expression = std::get_if<Expression>(&node.value);
  if (expression != nullptr && values.description.depends_on_t(*expression))
    text += " at t = " + number_text(values.variables[variable_t]);
  return text;
}

// Of values without a time (`t` is NaN), those that need one.
bool depends_on_time(const Node& node, const ImageValues& values) {
  return std::isnan(values.variables[0]) && TimeDependence(values.description).changes(node);
}

bool sound(const Node& node) {
  const NodeArray* array = node.array();
  return node.valid() && (array == nullptr || std::all_of(array->begin(), array->end(), sound));
}

Vec3 to_vector(const std::vector<double>& values) {
  return values.size() == 3 ? Vec3{values[0], values[1], values[2]} : Vec3{0.0};
}

}  // namespace

TableView::TableView(ImageValues& values, const Node* node, const KeyTable& keys)
    : values_(&values), node_(node), keys_(&keys) {
  if (!keys.selector.empty()) variant_ = find_variant(keys, text(keys.selector));
}

TableView TableView::top(ImageValues& values, std::string_view name) {
  const Entry* entry = find(values.description.root, name);
  return {values, entry != nullptr ? &entry->node : nullptr, *find_table(name)};
}

const Key& TableView::key(std::string_view name) const {
  const Key* found = find_key(*keys_, name);
  if (found == nullptr && variant_ != nullptr) found = find_key(*variant_, name);
  if (found == nullptr) throw std::logic_error("no key '" + std::string(name) + "'");
  return *found;
}

const Node* TableView::node_of(std::string_view name) const {
  const Entry* entry = node_ != nullptr ? find(*node_, name) : nullptr;
  return entry != nullptr ? &entry->node : nullptr;
}

bool TableView::has_valid(std::string_view name) const {
  const Node* node = node_of(name);
  return node != nullptr && node->valid();
}

bool TableView::is_sound(std::string_view name) const {
  const Node* node = node_of(name);
  return node == nullptr || sound(*node);
}

Place TableView::place(std::string_view name) const {
  const Node* node = node_of(name);
  return node != nullptr ? node->place : place();
}

std::optional<double> TableView::evaluated(const Node& node, const Key& key) const {
  double value = 0.0;
  if (const auto* number = std::get_if<double>(&node.value)) {
    value = *number;
  } else if (const auto* expression = std::get_if<Expression>(&node.value)) {
    // Any number that is allowed: what is found wrong with this one would be the parameter's fault.
    if (values_->uses_wrong_variable(*expression))
      return std::clamp(1.0, key.range.least, key.range.greatest);
    value = expression->evaluate(values_->variables);
  } else {
    return std::nullopt;
  }
  if (key.range.contains(value)) return value + 0.0;  // -0 becomes 0: equal numbers have equal bits
  std::string message = sentence(key, value, *values_, node);
  if (depends_on_time(node, *values_)) {
    message = "'" + std::string(key.name) + "' may not depend on t, frame or image_time";
  } else if (!std::isfinite(value)) {
    message += ", which is not a finite number";
  } else {
    message += ", but " + key.range.complaint(value);
  }
  values_->error(node.place, message);
  return std::nullopt;
}

double TableView::number(std::string_view name) const {
  if (const auto value = optional_number(name)) return *value;
  const Key& from = key(name);
  if (const auto* number = std::get_if<double>(&from.value)) return *number;
  if (const auto* formula = std::get_if<std::string>(&from.value); formula != nullptr && *formula == "t") {
    return values_->variables[0];
  }
  return 0.0;
}

std::optional<double> TableView::optional_number(std::string_view name) const {
  const Key& from = key(name);
  const Node* node = node_of(name);
  return node != nullptr ? evaluated(*node, from) : std::nullopt;
}

std::vector<double> TableView::default_numbers(const Key& key) const {
  const auto* numbers = std::get_if<std::vector<double>>(&key.value);
  return numbers != nullptr ? *numbers
                            : std::vector<double>(static_cast<std::size_t>(key.forms.front().count), 0.0);
}

std::vector<double> TableView::numbers_of(const Node* node, const Key& from) const {
  if (node == nullptr || node->array() == nullptr) return default_numbers(from);
  std::vector<double> values;
  bool good = true;
  for (const Node& element : *node->array()) {
    const auto value = evaluated(element, from);
    good = good && value.has_value();
    values.push_back(value.value_or(0.0));
  }
  return good ? values : default_numbers(from);
}

std::vector<double> TableView::numbers(std::string_view name) const {
  return numbers_of(node_of(name), key(name));
}

Dual TableView::moving(const Node* node, double value) const {
  const auto* expression = node != nullptr ? std::get_if<Expression>(&node->value) : nullptr;
  if (expression == nullptr || values_->rates.empty()) return {value, 0.0};
  const Dual dual = expression->evaluate(std::span<const Dual>(values_->rates));
  return {value, dual.derivative};
}

Dual TableView::moving_number(std::string_view name) const {
  const Node* node = node_of(name);
  const double value = number(name);
  if (node != nullptr) return moving(node, value);
  const auto* formula = std::get_if<std::string>(&key(name).value);
  return {value, formula != nullptr && *formula == "t" ? 1.0 : 0.0};
}

std::array<Dual, 3> TableView::moving_vector(std::string_view name) const {
  const Vec3 value = vector(name);
  const Node* node = node_of(name);
  const NodeArray* array = node != nullptr ? node->array() : nullptr;
  const bool whole = array != nullptr && array->size() == 3;
  std::array<Dual, 3> result;
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = moving(whole ? &(*array)[i] : nullptr, value[static_cast<glm::length_t>(i)]);
  }
  return result;
}

std::optional<Expression> TableView::own_formula(const Node& node) const {
  const auto* expression = std::get_if<Expression>(&node.value);
  if (expression == nullptr || !values_->description.depends_on_t(*expression)) return std::nullopt;
  return backlight::in_own_time(*values_, *expression);
}

std::optional<std::array<Expression, 3>> TableView::own_formulas(const Node* node, const Key& from) const {
  const NodeArray* array = node != nullptr ? node->array() : nullptr;
  if (array == nullptr || array->size() != 3) return std::nullopt;
  std::array<std::optional<Expression>, 3> formulas;
  for (std::size_t i = 0; i < 3; ++i) formulas[i] = own_formula((*array)[i]);
  if (std::ranges::none_of(formulas, [](const auto& formula) { return formula.has_value(); }))
    return std::nullopt;
  std::array<Expression, 3> whole;
  for (std::size_t i = 0; i < 3; ++i) {
    whole[i] = formulas[i] ? *formulas[i] : constant_formula(evaluated((*array)[i], from).value_or(0.0));
  }
  return whole;
}

std::optional<Expression> TableView::in_own_time(std::string_view name) const {
  const Node* node = node_of(name);
  return node != nullptr ? own_formula(*node) : std::nullopt;
}

std::optional<std::array<Expression, 3>> TableView::vector_in_own_time(std::string_view name) const {
  return own_formulas(node_of(name), key(name));
}

std::optional<std::array<Expression, 3>> TableView::vector_in_own_time(std::string_view name,
                                                                       std::size_t index) const {
  const Node* node = node_of(name);
  const NodeArray* array = node != nullptr ? node->array() : nullptr;
  return array != nullptr && index < array->size() ? own_formulas(&(*array)[index], key(name)) : std::nullopt;
}

Vec3 TableView::vector(std::string_view name) const {
  return to_vector(numbers(name));
}

Vec3 TableView::vector_at(std::string_view name, std::size_t index) const {
  const Node* node = node_of(name);
  const NodeArray* array = node != nullptr ? node->array() : nullptr;
  if (array == nullptr || index >= array->size()) return Vec3{0.0};
  return to_vector(numbers_of(&(*array)[index], key(name)));
}

bool TableView::boolean(std::string_view name) const {
  const Key& from = key(name);
  const Node* node = node_of(name);
  const auto* written = node != nullptr ? std::get_if<bool>(&node->value) : nullptr;
  if (written != nullptr) return *written;
  const auto* usual = std::get_if<bool>(&from.value);
  return usual != nullptr && *usual;
}

std::string TableView::text(std::string_view name) const {
  const Key& from = key(name);
  const Node* node = node_of(name);
  if (node != nullptr && node->text() != nullptr) return *node->text();
  const auto* usual = std::get_if<std::string>(&from.value);
  return usual != nullptr ? *usual : std::string();
}

TableView TableView::table(std::string_view name, std::string_view keys) const {
  return {*values_, node_of(name), *find_table(keys)};
}

bool TableView::complete() const {
  for (const KeyTable* keys : {keys_, variant_}) {
    if (keys == nullptr) continue;
    for (const Key& required : keys->keys) {
      if (std::holds_alternative<Required>(required.value) && !has_valid(required.name)) return false;
    }
  }
  return true;
}

std::string_view TableView::one_of(const std::vector<std::string_view>& keys) const {
  std::string_view found;
  for (const std::string_view name : keys) {
    if (!has(name)) continue;
    if (found.empty()) {
      found = name;
    } else {
      error(name, "'" + std::string(found) + "' and '" + std::string(name) + "' exclude each other",
            "give one of the two");
    }
  }
  return found;
}

void TableView::error(std::string_view name, std::string message, std::string hint) const {
  values_->error(place(name), std::move(message), std::move(hint));
}

void TableView::warning(std::string_view name, std::string message, std::string hint) const {
  values_->diagnostics.warning(values_->description.span(place(name)), std::move(message), std::move(hint));
}

}  // namespace backlight
