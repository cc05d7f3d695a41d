#include "references.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "words.h"

namespace backlight {
namespace {

class References {
 public:
  References(Description& description, Diagnostics& diagnostics)
      : description_(description), diagnostics_(diagnostics) {}

  void check() {
    define("frame", frames_);
    define("material", materials_);
    if (const auto world = frames_.find("world"); world != frames_.end()) {
      error(world->second->place, "the frame 'world' always exists and cannot be defined");
    }
    for (const char* list : {"object", "light", "camera"}) check_list(list);
    if (Entry* background = find(description_.root, "background")) refer(background->node, "frame", frames_);
    check_frames();
    warn_of_unused("frame", frames_, used_frames_);
    warn_of_unused("material", materials_, used_materials_);
  }

 private:
  using Definitions = std::map<std::string, Entry*, std::less<>>;

  void error(const Place& place, std::string message, std::string hint = {}) {
    diagnostics_.error(description_.span(place), std::move(message), std::move(hint));
  }

  // "file:line" of a definition, for the message about its duplicate.
  [[nodiscard]] std::string where(const Place& place) const {
    return description_.sources[place.source]->name + ":" + std::to_string(place.line);
  }

  void define(std::string_view table, Definitions& definitions) {
    Entry* entries = find(description_.root, table);
    if (entries == nullptr || entries->node.table() == nullptr) return;
    for (Entry& entry : *entries->node.table()) {
      const auto [there, added] = definitions.emplace(entry.name, &entry);
      if (added) continue;
      error(entry.place, "the " + std::string(table) + " '" + entry.name + "' is defined twice",
            "first at " + where(there->second->place));
    }
  }

  void check_list(std::string_view list) {
    Entry* entries = find(description_.root, list);
    if (entries == nullptr) return;
    if (entries->node.table() != nullptr) return refer(entries->node, "frame", frames_);
    if (entries->node.array() == nullptr) return;
    std::map<std::string, Place, std::less<>> names;
    for (Node& node : *entries->node.array()) {
      refer(node, "frame", frames_);
      refer(node, "material", materials_);
      check_parts(node);
      check_name(node, list, names, entries->node.array()->size());
    }
  }

  // The parts of a solid name materials too.
  void check_parts(Node& node) {
    Entry* parts = find(node, "part");
    if (parts == nullptr || parts->node.array() == nullptr) return;
    for (Node& part : *parts->node.array()) {
      refer(part, "material", materials_);
      check_parts(part);
    }
  }

  void check_name(const Node& node, std::string_view list, std::map<std::string, Place, std::less<>>& names,
                  std::size_t count) {
    const Entry* name = find(node, "name");
    if (name == nullptr) {
      if (list == "camera" && count > 1 && node.table() != nullptr) {
        error(node.place, "of several cameras, each needs a 'name'");
      }
      return;
    }
    if (name->node.text() == nullptr) return;
    const auto [there, added] = names.emplace(*name->node.text(), name->node.place);
    if (added) return;
    error(name->node.place, "two of [[" + std::string(list) + "]] are called '" + *name->node.text() + "'",
          "the first at " + where(there->second));
  }

  void refer(Node& table, std::string_view key, const Definitions& definitions) {
    Entry* reference = find(table, key);
    if (reference == nullptr || reference->node.text() == nullptr) return;
    const std::string name = *reference->node.text();
    if (key == "material") used_materials_.insert(name);
    if (key != "material") used_frames_.insert(name);
    if ((key != "material" && name == "world") || definitions.count(name) > 0) return;
    const std::string kind = key == "material" ? "material" : "frame";
    std::vector<std::string> names;
    if (kind == "frame") names.emplace_back("world");
    for (const auto& definition : definitions) names.push_back(definition.first);
    error(reference->node.place, "there is no " + kind + " '" + name + "'", did_you_mean(name, names));
    reference->node.value = Invalid{};
  }

  void check_frames() {
    for (auto& [name, entry] : frames_) refer(entry->node, "within", frames_);
    std::set<std::string> reported;
    for (auto& [name, entry] : frames_) {
      std::vector<std::string> way{name};
      for (std::string outer = outer_of(name); outer != "world"; outer = outer_of(outer)) {
        const bool again = std::find(way.begin(), way.end(), outer) != way.end();
        way.push_back(outer);
        if (!again) continue;
        if (outer == name && reported.insert(*std::min_element(way.begin(), way.end())).second) {
          error(find(entry->node, "within")->node.place,
                "frames lie within each other in a circle: " + arrows(way));
        }
        break;
      }
    }
    for (auto& [name, entry] : frames_) break_circle(name, *entry);
  }

  // So that compiling never follows a circle.
  void break_circle(const std::string& name, Entry& entry) {
    std::set<std::string> seen{name};
    for (std::string outer = outer_of(name); outer != "world"; outer = outer_of(outer)) {
      if (seen.insert(outer).second) continue;
      find(entry.node, "within")->node.value = Invalid{};
      return;
    }
  }

  [[nodiscard]] std::string outer_of(const std::string& name) const {
    const auto frame = frames_.find(name);
    if (frame == frames_.end()) return "world";
    const Entry* within = find(frame->second->node, "within");
    return within == nullptr || within->node.text() == nullptr ? "world" : *within->node.text();
  }

  static std::string arrows(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : " -> ") + name;
    return text;
  }

  void warn_of_unused(std::string_view table, const Definitions& definitions,
                      const std::set<std::string>& used) {
    for (const auto& [name, entry] : definitions) {
      if (used.count(name) > 0 || entry->place.source != 0) continue;
      diagnostics_.warning(description_.span(entry->place),
                           "the " + std::string(table) + " '" + name + "' is not used");
    }
  }

  Description& description_;
  Diagnostics& diagnostics_;
  Definitions frames_, materials_;
  std::set<std::string> used_frames_, used_materials_;
};

// Depth first over "uses"; a parameter met again on its own way closes a circle.
class ParameterOrder {
 public:
  ParameterOrder(Description& description, Diagnostics& diagnostics)
      : description_(description),
        diagnostics_(diagnostics),
        state_(description.variables.size(), State::unseen) {}

  void find_order() {
    for (std::size_t i = 2; i < state_.size(); ++i) visit(i);
  }

 private:
  enum class State { unseen, open, done };

  [[nodiscard]] Entry* entry(std::size_t variable) {
    Entry* parameters = find(description_.root, "params");
    return parameters == nullptr ? nullptr : find(parameters->node, description_.variables[variable]);
  }

  void visit(std::size_t variable) {
    if (state_[variable] != State::unseen) return;
    state_[variable] = State::open;
    way_.push_back(variable);
    Entry* parameter = entry(variable);
    // A copy: the parameter itself may be found invalid on the way.
    const Node node = parameter != nullptr ? parameter->node : Node{};
    if (const auto* expression = std::get_if<Expression>(&node.value)) {
      for (std::size_t i = 2; i < state_.size(); ++i) {
        if (!expression->uses(i)) continue;
        if (state_[i] == State::open) report(i, *parameter);
        visit(i);
      }
    }
    way_.pop_back();
    state_[variable] = State::done;
    description_.parameter_order.push_back(variable);
  }

  void report(std::size_t closing, Entry& parameter) {
    std::string names;
    for (auto step = std::find(way_.begin(), way_.end(), closing); step != way_.end(); ++step) {
      names += description_.variables[*step] + " -> ";
    }
    diagnostics_.error(description_.span(parameter.node.place),
                       "parameters use each other in a circle: " + names + description_.variables[closing]);
    parameter.node.value = Invalid{};
  }

  Description& description_;
  Diagnostics& diagnostics_;
  std::vector<State> state_;
  std::vector<std::size_t> way_;
};

void warn_of_unused_parameters(const Description& description, const std::vector<bool>& used,
                               Diagnostics& diagnostics) {
  const Entry* parameters = find(description.root, "params");
  for (std::size_t i = 2; parameters != nullptr && i < used.size(); ++i) {
    const Entry* entry = find(parameters->node, description.variables[i]);
    if (used[i] || entry == nullptr || entry->place.source != 0) continue;
    diagnostics.warning(description.span(entry->place), "the parameter '" + entry->name + "' is not used");
  }
}

}  // namespace

void check_references(Description& description, const std::vector<bool>& used, Diagnostics& diagnostics) {
  References(description, diagnostics).check();
  ParameterOrder(description, diagnostics).find_order();
  warn_of_unused_parameters(description, used, diagnostics);
}

}  // namespace backlight
