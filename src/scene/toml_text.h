// TOML text to nodes. The only file that knows the TOML library.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <string>
#include <string_view>
#include <variant>

#include "backlight/scene/description.h"

namespace backlight {

/// Why a text is not TOML, and where.
struct TomlError {
  Place place;
  std::string message;
};

/// The tables of a text, each value with its place. Numbers become doubles; strings stay strings.
/// Tables and arrays are in `memory`.
std::variant<Node, TomlError> parse_toml(
    std::string_view text, std::uint32_t source,
    std::pmr::memory_resource* memory = std::pmr::get_default_resource());

/// Moves every place in a one-line node onto line `line` and by `columns` to the right (or, if negative,
/// left): for a value that was parsed out of its context.
void move_places(Node& node, std::uint32_t line, int columns);

}  // namespace backlight
