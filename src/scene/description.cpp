#include "backlight/scene/description.h"

#include <algorithm>
#include <utility>

namespace backlight {

const Entry* find(const Node& table, std::string_view name) {
  const NodeTable* entries = table.table();
  if (entries == nullptr) return nullptr;
  const auto found =
      std::find_if(entries->begin(), entries->end(), [&](const Entry& e) { return e.name == name; });
  return found == entries->end() ? nullptr : &*found;
}

Entry* find(Node& table, std::string_view name) {
  return const_cast<Entry*>(find(static_cast<const Node&>(table), name));  // the table itself is not const
}

SourceSpan Description::span(const Place& place) const {
  if (place.line == 0 || place.source >= sources.size()) return {};
  return {sources[place.source], static_cast<int>(place.line), static_cast<int>(place.column),
          static_cast<int>(place.length)};
}

bool Description::depends_on_t(const Expression& expression) const {
  const std::size_t first = expression.variables() - variables.size();  // of x, y and z, if it is a surface's
  const std::vector<std::size_t> used = expression.used_variables();
  return std::any_of(used.begin(), used.end(),
                     [&](std::size_t i) { return i >= first && follows_t[i - first]; });
}

std::vector<const Entry*> Description::parameters() const {
  std::vector<const Entry*> entries(variables.size(), nullptr);
  const Entry* table = find(root, "params");
  if (table == nullptr || table->node.table() == nullptr) return entries;
  std::size_t next =
      first_parameter;  // they are in the order of the table, which may have unusable ones among them
  for (const Entry& entry : *table->node.table()) {
    if (next < variables.size() && entry.name == variables[next]) entries[next++] = &entry;
  }
  return entries;
}

void Description::forget_contents() {
  NodeTable kept;  // by copies, which are not in `memory`
  for (const Entry& entry : *root.table()) {
    if (entry.name != "object" && entry.name != "material" && entry.name != "light") kept.push_back(entry);
  }
  root.value = Invalid{};
  root.value = std::move(kept);
  sources.clear();
  memory->release();
}

std::vector<std::string> formula_variables(const Description& description) {
  std::vector<std::string> names{"x", "y", "z"};
  names.insert(names.end(), description.variables.begin(), description.variables.end());
  return names;
}

}  // namespace backlight
