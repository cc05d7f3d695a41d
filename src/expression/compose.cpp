#include "backlight/expression/compose.h"

#include <stdexcept>
#include <utility>
#include <vector>

#include "graph.h"

namespace backlight {

Composer::Composer(std::size_t variables) : graph_(std::make_unique<Graph>()), variables_(variables) {}
Composer::~Composer() = default;
Composer::Composer(Composer&&) noexcept = default;
Composer& Composer::operator=(Composer&&) noexcept = default;

Composer::Node Composer::constant(double value) {
  return graph_->constant(value);
}

Composer::Node Composer::variable(std::size_t index) {
  if (index >= variables_) throw std::invalid_argument("Composer: no such variable");
  return graph_->variable(static_cast<std::uint32_t>(index));
}

Composer::Node Composer::apply(Operation operation, Node a, Node b) {
  return graph_->apply(operation, a, b);
}

Composer::Node Composer::power(Node a, Node b) {
  return graph_->power(a, b);
}

Composer::Node Composer::insert(const Expression& expression, std::span<const Node> variables) {
  const Tape& tape = expression.tape();
  std::vector<Node> registers(tape.registers);  // what each register holds
  for (const Instruction& step : tape.instructions) {
    Node& out = registers[step.out];
    if (step.operation == Operation::constant) {
      out = graph_->constant(tape.constants[step.a]);
    } else if (step.operation == Operation::variable) {
      if (step.a >= variables.size()) throw std::invalid_argument("Composer: a variable has no node");
      out = variables[step.a];
    } else if (step.operation == Operation::pow) {
      out = graph_->power(registers[step.a], registers[step.b]);
    } else {
      out = graph_->apply(step.operation, registers[step.a], registers[step.b]);
    }
  }
  return registers[0];
}

Expression Composer::expression(Node root, std::string text) const {
  return Expression::from_tape(std::move(text), graph_->tape({&root, 1}), variables_);
}

Tape Composer::tape(std::span<const Node> roots) const {
  return graph_->tape(roots);
}

}  // namespace backlight
