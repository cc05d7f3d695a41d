#include "toml_text.h"

#include <toml++/toml.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "backlight/base/memory.h"

namespace backlight {
namespace {

// The TOML library recurses once for each part of a dotted key, without a limit of its own.
constexpr int longest_dotted_key = 64;
// And once for each table and array within another; it limits these, but not what dotted keys make of them.
constexpr int deepest_nesting = 512;

Place place_of(const toml::source_region& region, std::uint32_t source) {
  Place place{source, region.begin.line, region.begin.column, 1};
  if (region.end.line == region.begin.line && region.end.column > region.begin.column) {
    place.length = region.end.column - region.begin.column;
  }
  return place;
}

// After so many bytes of values memory is given back to the system.
constexpr std::size_t many_values = std::size_t{1} << 24U;

// The library's values take several times the room of ours, and there may be millions: what is converted is
// given back on the way.
class Converter {
 public:
  Converter(std::uint32_t source, std::pmr::memory_resource* memory) : source_(source), memory_(memory) {}

  NodeTable table(toml::table& from) {
    NodeTable table(memory_);
    table.reserve(from.size());
    for (auto&& [key, value] : from) {
      table.push_back({std::string(key.str()), place_of(key.source(), source_), node(value)});
    }
    count(from.size() * sizeof(Entry));
    from.clear();
    // The library sorts by name; the author's order is the one to report and to number in.
    std::stable_sort(table.begin(), table.end(), [](const Entry& a, const Entry& b) {
      return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
    });
    return table;
  }

 private:
  Node node(toml::node& from) {
    Node node;
    node.place = place_of(from.source(), source_);
    if (auto* entries = from.as_table()) {
      node.value = table(*entries);
    } else if (auto* elements = from.as_array()) {
      node.value = array(*elements);
    } else if (const auto* text = from.as_string()) {
      node.value = text->get();
    } else if (const auto* integer = from.as_integer()) {
      node.value = static_cast<double>(integer->get());
    } else if (const auto* real = from.as_floating_point()) {
      node.value = real->get();
    } else if (const auto* flag = from.as_boolean()) {
      node.value = flag->get();
    } else {
      node.value = Date{};
    }
    return node;
  }

  NodeArray array(toml::array& from) {
    NodeArray elements(memory_);
    elements.reserve(from.size());
    while (!from.empty()) {  // from the end, where it can be given back
      elements.push_back(node(from.back()));
      from.pop_back();
      count(sizeof(Node));
    }
    std::reverse(elements.begin(), elements.end());
    return elements;
  }

  // Of what has been converted, and given back to the C library.
  void count(std::size_t bytes) {
    converted_ += bytes;
    if (converted_ < many_values) return;
    return_freed_memory(std::exchange(converted_, 0));
  }

  std::uint32_t source_;
  std::pmr::memory_resource* memory_;
  std::size_t converted_ = 0;
};

// Counts positions in a text as diagnostics do.
struct Cursor {
  std::uint32_t line = 1;
  std::uint32_t column = 1;

  void pass(char c) {
    if (c == '\n') {
      ++line;
      column = 1;
    } else if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) {
      ++column;
    }
  }
};

TomlError too_deep(const Cursor& cursor, std::uint32_t source) {
  return {{source, cursor.line, cursor.column, 1},
          "tables and arrays are nested more than " + std::to_string(deepest_nesting) + " deep"};
}

// What would need too much of the stack: a key of too many parts (dots with nothing between them that ends a
// key), or too many values within each other.
std::optional<TomlError> overlong_way(std::string_view text, std::uint32_t source) {
  Cursor cursor;
  int dots = 0;
  int key_dots = 0;  // of the key whose value begins
  int depth = 0;
  std::vector<int> opened;  // how deep each open bracket goes
  char quote = 0;
  bool comment = false;
  for (const char c : text) {
    if (c == '\n') {
      quote = 0;
      comment = false;
    }
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (!comment) {
      if (c == '"' || c == '\'') quote = c;
      if (c == '#') comment = true;
      if ((c == ']' || c == '}') && !opened.empty()) {
        depth -= opened.back();
        opened.pop_back();
      }
      if (c == '[' || c == '{') {
        opened.push_back(key_dots + 1);
        depth += key_dots + 1;
        if (depth > deepest_nesting) return too_deep(cursor, source);
      }
      if (c == '=') key_dots = dots;
      if (std::string_view("\n,{}[]").find(c) != std::string_view::npos) key_dots = 0;
      if (std::string_view("\n#,={}[]").find(c) != std::string_view::npos) dots = 0;
      if (c == '.' && ++dots >= longest_dotted_key) {
        return TomlError{{source, cursor.line, cursor.column, 1},
                         "a dotted key of more than " + std::to_string(longest_dotted_key) + " parts"};
      }
    }
    cursor.pass(c);
  }
  return std::nullopt;
}

std::string message_of(const toml::parse_error& error) {
  std::string text(error.description());
  const std::string_view prefix = "Error while parsing ";
  if (text.starts_with(prefix)) {
    const std::size_t colon = text.find(": ");
    if (colon == std::string::npos) return "not valid TOML: in a " + text.substr(prefix.size());
    const std::string what = text.substr(prefix.size(), colon - prefix.size());
    const bool vowel = std::string_view("aeiou").find(what.front()) != std::string_view::npos;
    return "not valid TOML: " + text.substr(colon + 2) + (vowel ? " (in an " : " (in a ") + what + ")";
  }
  return "not valid TOML: " + text;
}

}  // namespace

std::variant<Node, TomlError> parse_toml(std::string_view text, std::uint32_t source,
                                         std::pmr::memory_resource* memory) {
  if (auto wrong = overlong_way(text, source)) return *std::move(wrong);
  try {
    Node root{NodeTable{}, {source, 1, 1, 1}};
    {
      toml::table table = toml::parse(text);
      root.value = Converter(source, memory).table(table);
    }
    return_freed_memory(text.size());
    return root;
  } catch (const toml::parse_error& error) {
    return TomlError{place_of(error.source(), source), message_of(error)};
  }
}

void move_places(Node& node, std::uint32_t line, int columns) {
  const auto move = [&](Place& place) {
    place.column = static_cast<std::uint32_t>(std::max(1, static_cast<int>(place.column) + columns));
    place.line = line;
  };
  move(node.place);
  if (NodeArray* array = node.array()) {
    for (Node& element : *array) move_places(element, line, columns);
  }
  if (NodeTable* table = node.table()) {
    for (Entry& entry : *table) {
      move(entry.place);
      move_places(entry.node, line, columns);
    }
  }
}

}  // namespace backlight
