// What a name followed by parentheses means: the functions of the table, and those made of several
// operations.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "graph.h"

namespace backlight {

/// How many arguments a function takes.
struct Arity {
  std::size_t least;
  std::size_t most;
};

/// Nothing when there is no function of this name.
std::optional<Arity> function_arity(std::string_view name);

/// The function applied to arguments whose number suits its arity.
Graph::Node apply_function(Graph& graph, std::string_view name, std::span<const Graph::Node> arguments);

/// The value of pi or e.
std::optional<double> named_constant(std::string_view name);

/// All names of the language: functions and constants.
std::vector<std::string> expression_names();

}  // namespace backlight
