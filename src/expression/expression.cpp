#include "backlight/expression/expression.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "graph.h"
#include "parser.h"

namespace backlight {

struct Expression::Compiled {
  std::string text;
  Tape tape;
  std::size_t variables;
};

namespace {

constexpr std::size_t registers_on_stack = 64;

template <class N>
N evaluate_tape(const Tape& tape, std::size_t variables, std::span<const N> values) {
  if (values.size() < variables) throw std::invalid_argument("Expression::evaluate: a variable has no value");
  if (tape.registers <= registers_on_stack) {
    std::array<N, registers_on_stack> registers;  // not initialised: each is written before it is read
    return run<N>(tape, values, registers);
  }
  std::vector<N> registers(tape.registers);
  return run<N>(tape, values, registers);
}

}  // namespace

Expression::Expression() {
  static const auto zero =
      std::make_shared<const Compiled>(Compiled{"0", Tape{{{Operation::constant, 0, 0, 0}}, {0.0}, 1}, 0});
  compiled_ = zero;
}

Expression::Expression(std::shared_ptr<const Compiled> compiled) : compiled_(std::move(compiled)) {}

Expression Expression::from_tape(std::string text, Tape tape, std::size_t variables) {
  return Expression(std::make_shared<const Compiled>(Compiled{std::move(text), std::move(tape), variables}));
}

VariableNames::VariableNames(std::vector<std::string> names) : names_(std::move(names)) {
  for (std::size_t i = 0; i < names_.size(); ++i) index_of_.emplace(names_[i], i);
}

std::optional<std::size_t> VariableNames::find(std::string_view name) const {
  const auto there = index_of_.find(std::string(name));
  return there == index_of_.end() ? std::nullopt : std::optional(there->second);
}

std::variant<Expression, ExpressionError> Expression::parse(std::string_view text,
                                                            const VariableNames& variables) {
  Graph graph;
  try {
    const Graph::Node root = Parser(text, variables, graph).parse();
    return Expression(std::make_shared<const Compiled>(
        Compiled{std::string(text), graph.tape({&root, 1}), variables.names().size()}));
  } catch (ExpressionError& error) {
    return std::move(error);
  }
}

double Expression::evaluate(std::span<const double> values) const {
  return evaluate_tape<double>(compiled_->tape, compiled_->variables, values);
}

Dual Expression::evaluate(std::span<const Dual> values) const {
  return evaluate_tape<Dual>(compiled_->tape, compiled_->variables, values);
}

Gradient Expression::evaluate(std::span<const Gradient> values) const {
  return evaluate_tape<Gradient>(compiled_->tape, compiled_->variables, values);
}

std::size_t Expression::variables() const {
  return compiled_->variables;
}

Expression Expression::bind(std::size_t first, std::span<const double> values) const {
  if (first + values.size() < compiled_->variables) {
    throw std::invalid_argument("Expression::bind: a variable has no value");
  }
  Graph graph;
  std::vector<Graph::Node> node(compiled_->tape.registers);  // what each register holds
  for (const Instruction& step : compiled_->tape.instructions) {
    Graph::Node& out = node[step.out];
    if (step.operation == Operation::constant) {
      out = graph.constant(compiled_->tape.constants[step.a]);
    } else if (step.operation == Operation::variable) {
      out = step.a < first ? graph.variable(step.a) : graph.constant(values[step.a - first]);
    } else if (step.operation == Operation::pow) {
      out = graph.power(node[step.a], node[step.b]);
    } else {
      out = graph.apply(step.operation, node[step.a], node[step.b]);
    }
  }
  const std::size_t left = std::min(first, compiled_->variables);
  return Expression(
      std::make_shared<const Compiled>(Compiled{compiled_->text, graph.tape({node.data(), 1}), left}));
}

bool Expression::uses(std::size_t variable) const {
  const auto& steps = compiled_->tape.instructions;
  return std::any_of(steps.begin(), steps.end(), [variable](const Instruction& step) {
    return step.operation == Operation::variable && step.a == variable;
  });
}

std::vector<std::size_t> Expression::used_variables() const {
  std::vector<std::size_t> used;
  for (const Instruction& step : compiled_->tape.instructions) {
    if (step.operation == Operation::variable) used.push_back(step.a);
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used;
}

std::optional<double> Expression::constant() const {
  const Tape& tape = compiled_->tape;
  if (tape.instructions.size() != 1 || tape.instructions[0].operation != Operation::constant)
    return std::nullopt;
  return tape.constants[0];
}

const std::string& Expression::text() const {
  return compiled_->text;
}

const Tape& Expression::tape() const {
  return compiled_->tape;
}

}  // namespace backlight
