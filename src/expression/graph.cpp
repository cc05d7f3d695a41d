#include "graph.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace backlight {
namespace {

constexpr double largest_multiplied_exponent = 32;
constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();

}  // namespace

Graph::Node Graph::insert(Entry entry) {
  const auto [place, is_new] = known_.try_emplace(entry, static_cast<Node>(entries_.size()));
  if (is_new) entries_.push_back(entry);
  return place->second;
}

int Graph::operands(Node node) const {
  const Operation operation = entries_[node].operation;
  if (operation == Operation::constant || operation == Operation::variable) return 0;
  return info(operation).operands;
}

Graph::Node Graph::constant(double value) {
  const auto [place, is_new] = known_constants_.try_emplace(std::bit_cast<std::uint64_t>(value),
                                                            static_cast<std::uint32_t>(constants_.size()));
  if (is_new) constants_.push_back(value);
  return insert({Operation::constant, place->second, 0});
}

Graph::Node Graph::variable(std::uint32_t index) {
  return insert({Operation::variable, index, 0});
}

Graph::Node Graph::apply(Operation operation, Node a, Node b) {
  const bool binary = info(operation).operands == 2;
  if (!binary) b = a;
  if (is_constant(a) && is_constant(b))
    return constant(backlight::apply<double>(operation, value(a), value(b)));
  const bool commutes = operation == Operation::add || operation == Operation::multiply;
  if (commutes && b < a) std::swap(a, b);
  return insert({operation, a, b});
}

Graph::Node Graph::power(Node a, Node b) {
  const bool multiplies =
      is_constant(b) && std::abs(value(b)) <= largest_multiplied_exponent && std::floor(value(b)) == value(b);
  if (!multiplies) return apply(Operation::pow, a, b);
  const double exponent = value(b);
  const double n = std::abs(exponent);
  if (n == 0.0) return constant(1.0);  // as pow does, for every a
  Node result = a;
  if (n == 2.0) result = apply(Operation::square, a);
  if (n > 2.0) result = apply(Operation::integer_power, a, constant(n));
  return exponent < 0.0 ? apply(Operation::divide, constant(1.0), result) : result;
}

std::vector<Graph::Node> Graph::last_uses(std::span<const Node> roots) const {
  // Walking down from the roots, a node is seen before its operands: the first mention is the last use.
  const auto end = static_cast<Node>(entries_.size());
  std::vector<Node> last_use(entries_.size(), unused);
  for (const Node root : roots) last_use[root] = end;
  for (Node node = end; node-- > 0;) {
    if (last_use[node] == unused) continue;
    const Entry& entry = entries_[node];
    const int count = operands(node);
    if (count > 0 && last_use[entry.a] == unused) last_use[entry.a] = node;
    if (count > 1 && last_use[entry.b] == unused) last_use[entry.b] = node;
  }
  return last_use;
}

Tape Graph::tape(std::span<const Node> roots) const {
  const std::vector<Node> last_use = last_uses(roots);
  std::vector<std::uint32_t> place(entries_.size());  // the register that holds a node
  std::vector<std::uint32_t> free;
  Tape tape;  // its first registers are kept for the results
  tape.registers = roots.size();
  for (Node node = 0; node < entries_.size(); ++node) {
    if (last_use[node] == unused) continue;
    const Entry& entry = entries_[node];
    Instruction step{entry.operation, 0, entry.a, entry.b};
    const int count = operands(node);
    if (count > 0) {
      step.a = place[entry.a];
      step.b = place[entry.b];
      if (last_use[entry.a] == node) free.push_back(step.a);
      if (entry.b != entry.a && last_use[entry.b] == node) free.push_back(step.b);
    } else if (entry.operation == Operation::constant) {
      step.a = static_cast<std::uint32_t>(tape.constants.size());
      tape.constants.push_back(value(node));
    }
    if (const auto root = std::ranges::find(roots, node); root != roots.end()) {
      step.out = static_cast<std::uint32_t>(root - roots.begin());
    } else if (free.empty()) {
      step.out = static_cast<std::uint32_t>(tape.registers++);
    } else {
      step.out = free.back();
      free.pop_back();
    }
    place[node] = step.out;
    tape.instructions.push_back(step);
  }
  for (std::uint32_t i = 1; i < roots.size(); ++i) {
    const auto same = static_cast<std::uint32_t>(std::ranges::find(roots, roots[i]) - roots.begin());
    if (same == i) continue;
    tape.instructions.push_back({Operation::negate, i, same, same});  // twice: a copy
    tape.instructions.push_back({Operation::negate, i, i, i});
  }
  return tape;
}

}  // namespace backlight
