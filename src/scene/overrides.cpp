#include "overrides.h"

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>
#include <utility>

#include "backlight/scene/keys.h"
#include "toml_text.h"
#include "words.h"

namespace backlight {
namespace {

// One part of a dotted path, with its place on the override's line.
struct Segment {
  std::string name;
  Place place;
};

bool is_space(char c) {
  return c == ' ' || c == '\t';
}

bool continues_code_point(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

// The number of characters, not bytes.
std::uint32_t characters(std::string_view text) {
  return static_cast<std::uint32_t>(text.size()) -
         static_cast<std::uint32_t>(std::count_if(text.begin(), text.end(), continues_code_point));
}

// Where the path ends: the first '=' outside quotes.
std::size_t equals_sign(std::string_view text) {
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (quote != 0) {
      if (text[i] == quote) quote = 0;
    } else if (text[i] == '"' || text[i] == '\'') {
      quote = text[i];
    } else if (text[i] == '=') {
      return i;
    }
  }
  return std::string_view::npos;
}

std::vector<Segment> split_path(std::string_view path, std::uint32_t source, std::uint32_t line) {
  std::vector<Segment> segments;
  std::size_t begin = 0;
  char quote = 0;
  for (std::size_t i = 0; i <= path.size(); ++i) {
    const bool at_end = i == path.size();
    if (!at_end && quote != 0 && path[i] == quote) {
      quote = 0;
    } else if (!at_end && quote == 0 && (path[i] == '"' || path[i] == '\'')) {
      quote = path[i];
    }
    if (!at_end && (quote != 0 || path[i] != '.')) continue;
    std::size_t first = begin, last = i;
    while (first < last && is_space(path[first])) ++first;
    while (last > first && is_space(path[last - 1])) --last;
    const std::uint32_t column = characters(path.substr(0, first)) + 1;
    const std::string_view written = path.substr(first, last - first);
    const Place place{source, line, column, std::max(1U, characters(written))};
    const bool quoted = written.size() >= 2 && written.front() == written.back() &&
                        (written.front() == '"' || written.front() == '\'');
    segments.push_back({std::string(quoted ? written.substr(1, written.size() - 2) : written), place});
    begin = i + 1;
  }
  return segments;
}

// What a node of the tree is, by the table of keys; null `keys` where its keys are names of the author's.
struct Spot {
  Node* node;
  const KeyTable* keys;
  ValueKind kind;
  std::string words;  // "[camera]", for messages
};

class Override {
 public:
  Override(Description& description, std::uint32_t source, std::uint32_t line, Diagnostics& diagnostics)
      : description_(description), source_(source), line_(line), diagnostics_(diagnostics) {}

  void apply(const std::string& text) {
    const std::size_t equals = equals_sign(text);
    if (equals == std::string_view::npos) {
      error({source_, line_, 1, characters(text)}, "an override has the form path=value");
      return;
    }
    const std::vector<Segment> path = split_path(std::string_view(text).substr(0, equals), source_, line_);
    for (const Segment& segment : path) {
      if (segment.name.empty()) return error(segment.place, "a part of the path is empty");
    }
    std::optional<Node> value = parse_value(text, equals + 1);
    Spot spot{&description_.root, find_table(""), ValueKind::table, "the scene"};
    for (std::size_t i = 0; value && i + 1 < path.size(); ++i) {
      if (!enter(spot, path[i])) return;
    }
    if (value) put(spot, path.back(), *std::move(value));
  }

 private:
  void error(const Place& place, std::string message, std::string hint = {}) {
    diagnostics_.error(description_.span(place), std::move(message), std::move(hint));
  }

  std::optional<Node> parse_value(std::string_view text, std::size_t begin) {
    while (begin < text.size() && is_space(text[begin])) ++begin;
    const std::string_view value = text.substr(begin);
    const std::uint32_t column = characters(text.substr(0, begin)) + 1;
    if (value.empty()) {
      error({source_, line_, column, 1}, "the value is missing",
            "an override changes a key or adds one; none takes a key out of the file");
      return std::nullopt;
    }
    const std::string_view prefix = "v = ";
    auto parsed = parse_toml(std::string(prefix) + std::string(value), source_);
    const int shift = static_cast<int>(column) - 1 - static_cast<int>(prefix.size());
    if (auto* root = std::get_if<Node>(&parsed); root != nullptr && root->table()->size() == 1) {
      Node node = std::move(root->table()->front().node);
      move_places(node, line_, shift);
      return node;
    }
    if (std::string_view("[{\"'").find(value.front()) == std::string_view::npos) {
      return Node{std::string(value), {source_, line_, column, characters(value)}};  // a bare word or formula
    }
    const auto* wrong = std::get_if<TomlError>(&parsed);
    Node at{Invalid{}, wrong != nullptr ? wrong->place : Place{source_, 1, 1, 1}};
    move_places(at, line_, shift);
    error(at.place, wrong != nullptr ? wrong->message : "one value is expected");
    return std::nullopt;
  }

  // From a table to the value of one of its keys, making missing tables; false when that is not possible.
  bool enter(Spot& spot, const Segment& segment) {
    if (spot.kind != ValueKind::table) return enter_element(spot, segment);
    const Key* key = find_key_of(spot, segment.name);
    if (key == nullptr) {
      unknown(spot, segment);
      return false;
    }
    const ValueForm* table = nullptr;
    for (const ValueForm& form : key->forms) {
      if (form.kind >= ValueKind::table && table == nullptr) table = &form;
    }
    Entry* entry = find(*spot.node, segment.name);
    if (table == nullptr || (entry != nullptr && !entry->node.table() && !entry->node.array())) {
      error(segment.place, "'" + segment.name + "' of " + spot.words + " is not a table");
      return false;
    }
    if (entry == nullptr) {
      if (table->kind != ValueKind::table) {
        error(segment.place, "the scene has no [" + segment.name + "]");
        return false;
      }
      spot.node->table()->push_back({segment.name, segment.place, Node{NodeTable{}, segment.place}});
      entry = &spot.node->table()->back();
    }
    const ValueKind kind = entry->node.array() != nullptr ? ValueKind::tables : table->kind;
    const KeyTable* keys = find_table(table->table);
    spot = {&entry->node, keys, kind, keys != nullptr ? std::string(keys->heading) : segment.name};
    return true;
  }

  // A key of the table, or of the variant that its selector chooses.
  static const Key* find_key_of(const Spot& spot, const std::string& name) {
    const Key* key = find_key(*spot.keys, name);
    if (key != nullptr || spot.keys->selector.empty()) return key;
    const Entry* choice = find(*spot.node, spot.keys->selector);
    if (choice == nullptr || choice->node.text() == nullptr) return nullptr;
    const KeyTable* variant = find_variant(*spot.keys, *choice->node.text());
    return variant != nullptr ? find_key(*variant, name) : nullptr;
  }

  // From a list or a table of named tables to one of them.
  bool enter_element(Spot& spot, const Segment& segment) {
    Node* found = element(*spot.node, segment.name);
    if (found == nullptr) {
      missing_element(spot, segment);
      return false;
    }
    spot = {found, spot.keys, ValueKind::table, spot.words};
    return true;
  }

  // By name, or by number from 1.
  static Node* element(Node& list, const std::string& name) {
    if (Entry* entry = find(list, name)) return &entry->node;
    NodeArray* array = list.array();
    if (array == nullptr) return nullptr;
    for (Node& node : *array) {
      const Entry* written = find(node, "name");
      if (written != nullptr && written->node.text() != nullptr && *written->node.text() == name)
        return &node;
    }
    std::size_t number = 0;
    const auto end = std::from_chars(name.data(), name.data() + name.size(), number);
    if (end.ptr != name.data() + name.size() || number < 1 || number > array->size()) return nullptr;
    return &(*array)[number - 1];
  }

  void put(Spot& spot, const Segment& segment, Node value) {
    if (spot.kind == ValueKind::table) {
      NodeTable* table = spot.node->table();
      if (table == nullptr) return error(segment.place, spot.words + " is not a table");
      if (Entry* entry = find(*spot.node, segment.name)) {
        *entry = {segment.name, segment.place, std::move(value)};
      } else {
        table->push_back({segment.name, segment.place, std::move(value)});
      }
    } else if (Node* there = element(*spot.node, segment.name)) {
      *there = std::move(value);
    } else {
      missing_element(spot, segment);
    }
  }

  void unknown(const Spot& spot, const Segment& segment) {
    std::vector<std::string> names;
    for (const Key& key : spot.keys->keys) names.emplace_back(key.name);
    error(segment.place, "unknown key '" + segment.name + "' in " + spot.words,
          did_you_mean(segment.name, names));
  }

  void missing_element(const Spot& spot, const Segment& segment) {
    std::vector<std::string> names;
    if (const NodeTable* table = spot.node->table()) {
      for (const Entry& entry : *table) names.push_back(entry.name);
    }
    if (const NodeArray* array = spot.node->array()) {
      for (const Node& node : *array) {
        const Entry* written = find(node, "name");
        if (written != nullptr && written->node.text() != nullptr) names.push_back(*written->node.text());
      }
    }
    const std::string kind = spot.kind == ValueKind::parameters ? "parameter" : std::string(spot.keys->name);
    error(segment.place, "there is no " + kind + " '" + segment.name + "'",
          did_you_mean(segment.name, names));
  }

  Description& description_;
  std::uint32_t source_;
  std::uint32_t line_;
  Diagnostics& diagnostics_;
};

}  // namespace

void apply_overrides(Description& description, const std::vector<std::string>& overrides,
                     Diagnostics& diagnostics) {
  if (overrides.empty()) return;
  std::string text;
  for (std::string line : overrides) {
    std::replace(line.begin(), line.end(), '\n', ' ');  // so that one override stays one line
    text += line + "\n";
  }
  const auto source = static_cast<std::uint32_t>(description.sources.size());
  description.sources.push_back(std::make_shared<const SourceText>(SourceText{"command line", text}));
  description.folders.emplace_back();
  description.overrides = overrides;
  for (std::size_t i = 0; i < overrides.size(); ++i) {
    std::string line = overrides[i];
    std::replace(line.begin(), line.end(), '\n', ' ');
    Override(description, source, static_cast<std::uint32_t>(i + 1), diagnostics).apply(line);
  }
}

}  // namespace backlight
