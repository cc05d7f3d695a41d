#include "references.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "words.h"

namespace backlight {
namespace {

// "a -> b -> a"; the middle of a long way is left out.
std::string arrows(const std::vector<std::string>& names) {
  constexpr std::size_t most_shown = 20;
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names.size() > most_shown && i == most_shown / 2) {
      i = names.size() - most_shown / 2;
      text += " -> ... (" + std::to_string(names.size() - most_shown) + " more)";
    }
    text += (text.empty() ? "" : " -> ") + names[i];
  }
  return text;
}

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

  static std::string definition_hint(const std::string& kind, const std::vector<std::string>& names) {
    constexpr std::size_t most_listed = 12;
    const bool short_list = !names.empty() && names.size() <= most_listed;
    return (short_list ? "there is " + listed(names, "and") + "; " : "") + "a table [" + kind +
           ".NAME] defines one";
  }

  void refer(Node& table, std::string_view key, const Definitions& definitions) {
    Entry* reference = find(table, key);
    if (reference == nullptr || reference->node.text() == nullptr) return;
    const std::string name = *reference->node.text();
    if (key == "material") used_materials_.insert(name);
    if (key != "material") used_frames_.insert(name);
    // A mesh may take the materials of its own file.
    const Entry* shape = key == "material" && name == "file" ? find(table, "shape") : nullptr;
    if (shape != nullptr && shape->node.text() != nullptr && *shape->node.text() == "mesh") return;
    if ((key != "material" && name == "world") || definitions.count(name) > 0) return;
    const std::string kind = key == "material" ? "material" : "frame";
    std::vector<std::string> names;
    if (kind == "frame") names.emplace_back("world");
    // To look for the nearest one takes as long as there are names.
    constexpr std::size_t most_hints = 200;
    if (diagnostics_.error_count() < most_hints) {
      for (const auto& definition : definitions) names.push_back(definition.first);
    }
    std::string hint = did_you_mean(name, names);
    if (hint.empty()) hint = definition_hint(kind, names);
    error(reference->node.place, "there is no " + kind + " '" + name + "'", hint);
    reference->node.value = Invalid{};
  }

  // Along `within` from frame to frame, none of them twice. A circle is broken where it is reported, so that
  // compiling never follows one.
  void check_frames() {
    for (auto& [name, entry] : frames_) refer(entry->node, "within", frames_);
    std::map<std::string, std::size_t, std::less<>> seen;  // the walk that came by
    std::size_t walk = 0;
    for (const auto& [name, entry] : frames_) {
      ++walk;
      std::vector<std::string> way;
      std::string next = name;
      while (next != "world" && seen.emplace(next, walk).second) {
        way.push_back(next);
        next = outer_of(next);
      }
      if (next == "world" || seen.at(next) != walk) continue;
      way.erase(way.begin(), std::find(way.begin(), way.end(), next));
      std::rotate(way.begin(), std::min_element(way.begin(), way.end()), way.end());
      break_circle(std::move(way));
    }
  }

  void break_circle(std::vector<std::string> way) {
    Node& within = find(frames_.at(way.front())->node, "within")->node;
    way.push_back(way.front());
    error(within.place, "frames lie within each other in a circle: " + arrows(way));
    within.value = Invalid{};
  }

  [[nodiscard]] std::string outer_of(const std::string& name) const {
    const auto frame = frames_.find(name);
    if (frame == frames_.end()) return "world";
    const Entry* within = find(frame->second->node, "within");
    return within == nullptr || within->node.text() == nullptr ? "world" : *within->node.text();
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

// Depth first over "uses", without recursion: a chain may be as long as the file. A parameter met again on
// its own way closes a circle.
class ParameterOrder {
 public:
  ParameterOrder(Description& description, Diagnostics& diagnostics)
      : description_(description),
        diagnostics_(diagnostics),
        parameters_(description.parameters()),
        state_(description.variables.size(), State::unseen) {}

  void find_order() {
    description_.follows_t.assign(description_.variables.size(), false);
    description_.follows_t[variable_t] = true;
    for (std::size_t i = first_parameter; i < state_.size(); ++i) {
      if (state_[i] == State::unseen) open(i);
      while (!way_.empty()) go_on();
    }
  }

 private:
  enum class State { unseen, open, done };

  // A parameter on the way, and those that it uses and that are still to be looked at.
  struct Step {
    std::size_t variable;
    std::vector<std::size_t> uses;
  };

  void open(std::size_t variable) {
    state_[variable] = State::open;
    way_.push_back({variable, {}});
    const auto* expression = std::get_if<Expression>(&parameters_[variable]->node.value);
    if (expression == nullptr) return;
    way_.back().uses = expression->used_variables();
    std::reverse(way_.back().uses.begin(), way_.back().uses.end());  // taken from the end
  }

  void go_on() {
    Step& step = way_.back();
    if (step.uses.empty()) {
      state_[step.variable] = State::done;
      description_.parameter_order.push_back(step.variable);
      const auto* formula = std::get_if<Expression>(&parameters_[step.variable]->node.value);
      description_.follows_t[step.variable] = formula != nullptr && description_.depends_on_t(*formula);
      way_.pop_back();
      return;
    }
    const std::size_t used = step.uses.back();
    step.uses.pop_back();
    if (used < first_parameter) return;
    if (state_[used] == State::open) report(used, step.variable);
    if (state_[used] == State::unseen) open(used);
  }

  void report(std::size_t closing, std::size_t variable) {
    std::vector<std::string> names{description_.variables[closing]};
    for (auto step = way_.rbegin(); step->variable != closing; ++step)
      names.push_back(description_.variables[step->variable]);
    names.push_back(description_.variables[closing]);
    std::reverse(names.begin(), names.end());
    Entry& parameter = const_cast<Entry&>(*parameters_[variable]);  // the description itself is not const
    diagnostics_.error(description_.span(parameter.node.place),
                       "parameters use each other in a circle: " + arrows(names));
    parameter.node.value = Invalid{};
  }

  Description& description_;
  Diagnostics& diagnostics_;
  std::vector<const Entry*> parameters_;
  std::vector<State> state_;
  std::vector<Step> way_;
};

void warn_of_unused_parameters(const Description& description, const std::vector<bool>& used,
                               Diagnostics& diagnostics) {
  const std::vector<const Entry*> parameters = description.parameters();
  for (std::size_t i = first_parameter; i < used.size(); ++i) {
    const Entry* entry = parameters[i];
    if (used[i] || entry->place.source != 0) continue;
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
