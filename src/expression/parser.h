// Text -> graph, by recursive descent over the grammar in expression.h.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "backlight/expression/expression.h"
#include "graph.h"

namespace backlight {

class Parser {
 public:
  Parser(std::string_view text, const VariableNames& variables, Graph& graph)
      : text_(text), variables_(variables), graph_(graph) {}

  /// The node of the whole text. Throws ExpressionError.
  Graph::Node parse();

 private:
  enum class Kind { number, name, symbol, end };

  /// The characters [begin, end) of the text. A symbol is one character (all bytes of it).
  struct Token {
    Kind kind = Kind::end;
    std::size_t begin = 0;
    std::size_t end = 0;
    double value = 0.0;
  };

  void advance();
  [[nodiscard]] std::size_t scan_number(std::size_t begin);
  [[nodiscard]] std::string_view spelling(const Token& token) const;
  [[nodiscard]] bool at(std::string_view symbol) const;
  bool accept(std::string_view symbol);

  Graph::Node sum();
  Graph::Node product();
  Graph::Node signed_value();
  Graph::Node power();
  Graph::Node value();
  Graph::Node name();
  Graph::Node call(const Token& function);
  std::vector<Graph::Node> arguments(const Token& function);

  void close(const Token& opening);
  [[noreturn]] void fail(const Token& token, std::string message, std::string hint = {}) const;
  [[noreturn]] void fail_at_token() const;
  [[noreturn]] void fail_unknown(const Token& name) const;
  [[nodiscard]] std::string missing_operator_hint() const;

  std::string_view text_;
  const VariableNames& variables_;
  Graph& graph_;
  Token token_;     // the next one, not yet consumed
  Token previous_;  // the last one consumed
  int depth_ = 0;
};

}  // namespace backlight
