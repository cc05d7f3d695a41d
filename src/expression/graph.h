// An expression as a graph: equal subexpressions are one node, and what depends on no variable is already a
// number.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "backlight/expression/tape.h"

namespace backlight {

/// Builds an expression bottom up. A node's operands are always older than the node.
class Graph {
 public:
  using Node = std::uint32_t;

  Node constant(double value);
  Node variable(std::uint32_t index);

  /// `operation` on its operands (`b` is ignored for one operand). Folded when the operands are constants: by
  /// the evaluator itself, so that the value has the bits it would have had at run time.
  Node apply(Operation operation, Node a, Node b = 0);

  /// a^b. A constant whole exponent n, |n| <= 32, becomes multiplications (about log2 n of them, and within
  /// |n| ulp of the exact value), which is defined for every a; any other exponent is libm's pow.
  Node power(Node a, Node b);

  /// The instructions for what the roots need, with registers used again as soon as they are free.
  [[nodiscard]] Tape tape(std::span<const Node> roots) const;

 private:
  struct Entry {
    Operation operation;
    std::uint32_t a;  // an operand, or the index of a constant or a variable
    std::uint32_t b;
    auto operator<=>(const Entry&) const = default;
  };

  Node insert(Entry entry);
  [[nodiscard]] bool is_constant(Node node) const { return entries_[node].operation == Operation::constant; }
  [[nodiscard]] double value(Node node) const { return constants_[entries_[node].a]; }
  [[nodiscard]] int operands(Node node) const;
  /// For each node the youngest node that reads it, or the largest index when no root needs it; for a root
  /// one that is younger than all.
  [[nodiscard]] std::vector<Node> last_uses(std::span<const Node> roots) const;

  std::vector<Entry> entries_;
  std::vector<double> constants_;
  std::map<Entry, Node> known_;
  std::map<std::uint64_t, std::uint32_t> known_constants_;  // by bits: 0 and -0 differ
};

}  // namespace backlight
