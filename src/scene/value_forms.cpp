#include "value_forms.h"

namespace backlight {

bool matches(const ValueForm& form, const Node& node) {
  switch (form.kind) {
    case ValueKind::boolean:
      return std::holds_alternative<bool>(node.value);
    case ValueKind::number:
      return std::holds_alternative<double>(node.value) || node.text() != nullptr;
    case ValueKind::numbers:
    case ValueKind::colours:
    case ValueKind::points:
    case ValueKind::choices:
    case ValueKind::paths:
    case ValueKind::tables:
      return node.array() != nullptr;
    case ValueKind::formula:
      return form.count > 0 ? node.array() != nullptr : node.text() != nullptr;
    case ValueKind::text:
    case ValueKind::choice:
    case ValueKind::path:
    case ValueKind::reference:
      return node.text() != nullptr;
    case ValueKind::table:
    case ValueKind::named_tables:
    case ValueKind::parameters:
      return node.table() != nullptr;
  }
  return false;
}

std::string form_words(const ValueForm& form) {
  switch (form.kind) {
    case ValueKind::boolean:
      return "true or false";
    case ValueKind::number:
      return "a number";
    case ValueKind::numbers:
      return form.count == 0 ? "an array of numbers"
                             : "an array of " + std::to_string(form.count) + " numbers";
    case ValueKind::colours:
      return "an array of " + std::to_string(form.count) + " colors";
    case ValueKind::points:
      return "an array of " + std::to_string(form.count) + " points";
    case ValueKind::formula:
      return form.count > 0 ? "an array of " + std::to_string(form.count) + " formulas"
                            : "a formula in a string";
    case ValueKind::text:
    case ValueKind::choice:
      return "a string";
    case ValueKind::choices:
      return "an array of strings";
    case ValueKind::path:
      return "the path of a file";
    case ValueKind::paths:
      return "an array of paths of files";
    case ValueKind::reference:
      return "the name of a " + std::string(form.table);
    case ValueKind::table:
    case ValueKind::named_tables:
    case ValueKind::parameters:
      return "a table";
    case ValueKind::tables:
      return "an array of tables";
  }
  return {};
}

}  // namespace backlight
