// Expressions made of other expressions.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "backlight/expression/expression.h"

namespace backlight {

class Graph;

/// Builds an expression bottom up in one shared graph: what its parts have in common is computed once.
class Composer {
 public:
  using Node = std::uint32_t;

  /// `variables`: of the expression to be made.
  explicit Composer(std::size_t variables);
  ~Composer();
  Composer(Composer&&) noexcept;
  Composer& operator=(Composer&&) noexcept;

  Node constant(double value);
  /// Throws std::invalid_argument when there is no variable of this index.
  Node variable(std::size_t index);
  /// `b` is ignored for an operation of one operand.
  Node apply(Operation operation, Node a, Node b = 0);
  /// a^b as the parser makes it of a text: multiplications where b is a whole number.
  Node power(Node a, Node b);
  /// The expression with nodes in the place of its variables. Throws std::invalid_argument when there are
  /// fewer nodes than the variables that it uses.
  Node insert(const Expression& expression, std::span<const Node> variables);

  /// The expression of a node. `text`: what Expression::text() will say.
  [[nodiscard]] Expression expression(Node root, std::string text) const;
  /// Of several nodes: what they have in common is computed once.
  [[nodiscard]] Tape tape(std::span<const Node> roots) const;

 private:
  std::unique_ptr<Graph> graph_;
  std::size_t variables_;
};

}  // namespace backlight
