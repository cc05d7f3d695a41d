#include "check.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <utility>

#include "backlight/scene/keys.h"
#include "check_numbers.h"
#include "value_forms.h"
#include "words.h"

namespace backlight {
namespace {

// Words of the format that this version does not know yet, so that they are not taken for slips.
struct NotYet {
  std::string_view table;
  std::string_view name;
  std::string_view instead;
};
constexpr std::array<NotYet, 1> keys_not_yet{{{"object", "file", ""}}};

bool is_identifier(const std::string& name) {
  const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  return !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
         std::all_of(name.begin(), name.end(), is_word);
}

class Checker {
 public:
  Checker(Description& description, Diagnostics& diagnostics)
      : description_(description), diagnostics_(diagnostics), numbers_(description, diagnostics) {}

  void table(Node& node, const KeyTable& keys, const std::string& where) {
    const KeyTable* variant = nullptr;
    const bool variant_known = find_variant_of(node, keys, variant);
    for (Entry& entry : *node.table()) {
      const Key* key = find_key(keys, entry.name);
      if (key == nullptr && variant != nullptr) key = find_key(*variant, entry.name);
      if (key != nullptr) {
        value(entry.node, *key, where);
      } else if (variant_known || !belongs_to_a_variant(keys, entry.name)) {
        unknown(entry, keys, variant, where);
      }
    }
    required(node, keys, where);
    if (variant != nullptr) {
      required(node, *variant, where + " (" + std::string(choice_of(*variant)) + ")");
    }
  }

  [[nodiscard]] const std::vector<bool>& used() const { return numbers_.used(); }

 private:
  void error(const Place& place, std::string message, std::string hint = {}) {
    diagnostics_.error(description_.span(place), std::move(message), std::move(hint));
  }

  // False when the key that chooses the variant is wrong, so that nothing is known about the variant's keys.
  static bool find_variant_of(const Node& node, const KeyTable& keys, const KeyTable*& variant) {
    if (keys.selector.empty()) return true;
    const Key& selector = *find_key(keys, keys.selector);
    const Entry* written = find(node, keys.selector);
    if (written == nullptr) {
      if (const auto* usual = std::get_if<std::string>(&selector.value)) variant = find_variant(keys, *usual);
    } else if (const std::string* choice = written->node.text()) {
      variant = find_variant(keys, *choice);
    }
    return variant != nullptr;
  }

  static bool belongs_to_a_variant(const KeyTable& keys, const std::string& name) {
    if (keys.selector.empty()) return false;
    const Key& selector = *find_key(keys, keys.selector);
    const auto has = [&](std::string_view choice) {
      return find_key(*find_variant(keys, choice), name) != nullptr;
    };
    return std::any_of(selector.choices.begin(), selector.choices.end(), has) || name == "file";
  }

  void unknown(const Entry& entry, const KeyTable& keys, const KeyTable* variant, const std::string& where) {
    for (const NotYet& later : keys_not_yet) {
      if (later.table == keys.name && later.name == entry.name) {
        return error(entry.place, "'" + entry.name + "' is not available in this version",
                     std::string(later.instead));
      }
    }
    std::vector<std::string> names;
    for (const KeyTable* from : {&keys, variant}) {
      if (from == nullptr) continue;
      for (const Key& key : from->keys) names.emplace_back(key.name);
    }
    std::string hint = did_you_mean(entry.name, names);
    if (belongs_to_a_variant(keys, entry.name)) hint = other_variant(entry.name, keys, *variant);
    if (hint.empty()) hint = "its keys are " + listed(names, "and");
    error(entry.place, "unknown key '" + entry.name + "' in " + where, hint);
  }

  static std::string other_variant(const std::string& name, const KeyTable& keys, const KeyTable& variant) {
    const Key& selector = *find_key(keys, keys.selector);
    std::vector<std::string> owners;
    for (const std::string_view choice : selector.choices) {
      if (find_key(*find_variant(keys, choice), name) != nullptr) owners.emplace_back(choice);
    }
    std::vector<std::string> own;
    for (const Key& key : variant.keys) own.push_back("'" + std::string(key.name) + "'");
    const std::string chosen(choice_of(variant));
    if (owners.empty()) return {};
    return "'" + name + "' is for " + std::string(keys.selector) + " " + listed(owners) + "; " + chosen +
           " has " + (own.empty() ? "no key of its own" : listed(own, "and"));
  }

  void required(const Node& node, const KeyTable& keys, const std::string& where) {
    for (const Key& key : keys.keys) {
      if (!std::holds_alternative<Required>(key.value) || find(node, key.name) != nullptr) continue;
      const std::vector<std::string> choices(key.choices.begin(), key.choices.end());
      error(node.place, "'" + std::string(key.name) + "' is missing in " + where,
            "it is " + (choices.empty() ? form_words(key.forms.front()) : "one of " + listed(choices)));
    }
  }

  void value(Node& node, const Key& key, const std::string& where) {
    const auto form = std::find_if(key.forms.begin(), key.forms.end(),
                                   [&](const ValueForm& candidate) { return matches(candidate, node); });
    if (form == key.forms.end()) {
      std::vector<std::string> expected;
      for (const ValueForm& candidate : key.forms) expected.push_back(form_words(candidate));
      error(node.place,
            "'" + std::string(key.name) + "' must be " + listed(expected) + ", not " + kind_words(node),
            form_hint(key, node));
      node.value = Invalid{};
      return;
    }
    value_of_form(node, key, *form, where);
  }

  // How the heading of a table is written, for those who miscounted its brackets; what is in a table; which
  // words there are.
  static std::string form_hint(const Key& key, const Node& node) {
    const std::string name(key.name);
    const ValueKind last = key.forms.back().kind;
    if (last == ValueKind::tables) return "each one begins with [[" + name + "]]";
    if (last == ValueKind::named_tables) return "each one begins with [" + name + ".NAME]";
    if (!key.choices.empty()) return "it is one of " + listed({key.choices.begin(), key.choices.end()});
    const auto form = std::ranges::find(key.forms, ValueKind::table, &ValueForm::kind);
    if (form == key.forms.end()) return {};
    const bool is_heading =
        node.array() != nullptr && !node.array()->empty() && node.array()->front().table() != nullptr;
    if (is_heading) return "there is one: its heading is [" + name + "]";
    std::vector<std::string> names;
    for (const Key& its : find_table(form->table)->keys) names.emplace_back(its.name);
    return "its keys are " + listed(names, "and");
  }

  void value_of_form(Node& node, const Key& key, const ValueForm& form, const std::string& where) {
    switch (form.kind) {
      case ValueKind::number:
        return numbers_.number(node, key);
      case ValueKind::numbers:
        return numbers_.numbers(node, key, form);
      case ValueKind::colours:
      case ValueKind::points:
        return numbers_.triples(node, key, form);
      case ValueKind::formula:
        return form.count > 0 ? numbers_.formulas(node, key, form) : numbers_.formula(node);
      case ValueKind::choice:
        return choice(node, key);
      case ValueKind::choices:
        return strings(node, key, true);
      case ValueKind::paths:
        return strings(node, key, false);
      case ValueKind::table:
        return table(node, *find_table(form.table), name_of_table(key, form, where));
      case ValueKind::tables:
        return tables(node, key, form);
      case ValueKind::named_tables:
        return named_tables(node, form);
      case ValueKind::parameters:
        return parameters(node);
      case ValueKind::boolean:
      case ValueKind::text:
      case ValueKind::path:
      case ValueKind::reference:
        return;
    }
  }

  static std::string name_of_table(const Key& key, const ValueForm& form, const std::string& where) {
    if (where == "the scene") return "[" + std::string(form.table) + "]";
    return "'" + std::string(key.name) + "' of " + where;
  }

  void choice(Node& node, const Key& key) {
    const std::string text = *node.text();
    if (std::find(key.choices.begin(), key.choices.end(), text) != key.choices.end()) return;
    node.value = Invalid{};
    if (key.name == "shape" && text == "mesh") {
      return error(node.place, "the shape 'mesh' is not available in this version");
    }
    if (key.name == "shape" && (text == "polynomial" || text == "csg")) {
      return error(node.place, "'" + text + "' is not a value of 'shape'",
                   text == "csg" ? "it is one of union, intersection or difference, with [[object.part]]"
                                 : "write it as shape = \"implicit\" with a formula f");
    }
    const std::vector<std::string> names(key.choices.begin(), key.choices.end());
    const std::string near = did_you_mean(text, names);
    const std::string hint = (near.empty() ? "" : near + " ") + "it is one of " + listed(names);
    error(node.place, "'" + text + "' is not a value of '" + std::string(key.name) + "'", hint);
  }

  void strings(Node& node, const Key& key, bool chosen) {
    for (Node& element : *node.array()) {
      if (element.text() == nullptr) {
        error(element.place,
              "'" + std::string(key.name) + "' must be made of strings, and this is " + kind_words(element));
        element.value = Invalid{};
      } else if (chosen) {
        choice(element, key);
      }
    }
  }

  void tables(Node& node, const Key& key, const ValueForm& form) {
    const KeyTable& keys = *find_table(form.table);
    const std::string where = "[[" + std::string(keys.name) + "]]";
    if (node.array()->empty() && key.name == "part") {
      return error(node.place, "'part' is empty: a solid is made of at least one part");
    }
    for (Node& element : *node.array()) {
      if (element.table() != nullptr) {
        table(element, keys, where);
      } else {
        error(element.place,
              "'" + std::string(key.name) + "' must be made of tables, and this is " + kind_words(element));
        element.value = Invalid{};
      }
    }
  }

  void named_tables(Node& node, const ValueForm& form) {
    for (Entry& entry : *node.table()) {
      const std::string where = "[" + std::string(form.table) + "." + entry.name + "]";
      if (entry.node.table() != nullptr) {
        table(entry.node, *find_table(form.table), where);
      } else {
        error(entry.place, where + " must be a table, not " + kind_words(entry.node),
              "[" + std::string(form.table) + ".NAME] holds the keys of the " + std::string(form.table) +
                  " NAME");
        entry.node.value = Invalid{};
      }
    }
  }

  void parameters(Node& node) {
    for (Entry& entry : *node.table()) {
      value(entry.node, {entry.name, {ValueKind::number}, Nothing{}, "", "", {}, {}}, "[params]");
    }
  }

  Description& description_;
  Diagnostics& diagnostics_;
  NumberCheck numbers_;
};

}  // namespace

void collect_variables(Description& description, Diagnostics& diagnostics) {
  description.variables = {"t", "frame", "image_time"};
  const Entry* parameters = find(description.root, "params");
  const NodeTable* table = parameters != nullptr ? parameters->node.table() : nullptr;
  if (table == nullptr) return;
  for (const Entry& entry : *table) {
    std::string problem;
    if (!is_identifier(entry.name)) {
      problem = "a parameter's name is made of letters, digits and '_', and begins with none of the digits";
    } else if (entry.name == "t" || entry.name == "frame" || entry.name == "image_time" ||
               is_expression_name(entry.name)) {
      problem = "'" + entry.name + "' already has a meaning in expressions: choose another name";
    }
    if (problem.empty()) {
      description.variables.push_back(entry.name);
    } else {
      diagnostics.error(description.span(entry.place), problem);
    }
  }
}

std::vector<bool> check_structure(Description& description, Diagnostics& diagnostics) {
  Checker checker(description, diagnostics);
  checker.table(description.root, *find_table(""), "the scene");
  return checker.used();
}

}  // namespace backlight
