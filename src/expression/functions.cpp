#include "functions.h"

#include <limits>
#include <numbers>

#include "backlight/expression/expression.h"

namespace backlight {
namespace {

constexpr std::string_view clamp_name = "clamp";

const OperationInfo* find_operation(std::string_view name) {
  if (name.empty()) return nullptr;
  for (const OperationInfo& row : operation_table) {
    if (row.function_name == name) return &row;
  }
  return nullptr;
}

bool is_chain(Operation operation) {
  return operation == Operation::min || operation == Operation::max;
}

}  // namespace

std::optional<Arity> function_arity(std::string_view name) {
  if (name == clamp_name) return Arity{3, 3};
  const OperationInfo* row = find_operation(name);
  if (row == nullptr) return std::nullopt;
  const auto operands = static_cast<std::size_t>(row->operands);
  return Arity{operands, is_chain(row->operation) ? std::numeric_limits<std::size_t>::max() : operands};
}

Graph::Node apply_function(Graph& graph, std::string_view name, std::span<const Graph::Node> arguments) {
  if (name == clamp_name) {
    return graph.apply(Operation::min, graph.apply(Operation::max, arguments[0], arguments[1]), arguments[2]);
  }
  const Operation operation = find_operation(name)->operation;
  if (operation == Operation::pow) return graph.power(arguments[0], arguments[1]);
  if (arguments.size() == 1) return graph.apply(operation, arguments[0]);
  Graph::Node result = arguments[0];
  for (const Graph::Node argument : arguments.subspan(1)) result = graph.apply(operation, result, argument);
  return result;
}

std::optional<double> named_constant(std::string_view name) {
  if (name == "pi") return std::numbers::pi;
  if (name == "e") return std::numbers::e;
  return std::nullopt;
}

std::vector<std::string> expression_names() {
  std::vector<std::string> names{"pi", "e", std::string(clamp_name)};
  for (const OperationInfo& row : operation_table) {
    if (!row.function_name.empty()) names.emplace_back(row.function_name);
  }
  return names;
}

bool is_expression_name(std::string_view name) {
  return named_constant(name).has_value() || function_arity(name).has_value();
}

}  // namespace backlight
