#include "parser.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <system_error>
#include <utility>

#include "backlight/base/diagnostics.h"
#include "functions.h"

namespace backlight {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool starts_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool continues_name(char c) {
  return starts_name(c) || is_digit(c);
}
bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}
bool continues_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

int count_characters(std::string_view text) {
  return static_cast<int>(
      std::count_if(text.begin(), text.end(), [](char c) { return !continues_character(c); }));
}

std::string quoted(std::string_view text) {
  return "'" + std::string(text) + "'";
}

std::string hint_for_character(std::string_view character) {
  if (character == "−" || character == "–") return "write the minus sign as - (the ASCII hyphen)";
  if (character == "×" || character == "·" || character == "⋅") return "write * for multiplication";
  if (character == "÷") return "write / for division";
  if (character == "²") return "write ^2";
  if (character == "π") return "write pi";
  if (character == "=") return "a formula has one side: instead of f = g write f - g, which is 0 there";
  if (character == "%") return "write mod(a, b) for the remainder";
  return {};
}

std::string describe(const Arity& arity) {
  if (arity.most != arity.least) return "at least " + std::to_string(arity.least) + " arguments";
  return std::to_string(arity.least) + (arity.least == 1 ? " argument" : " arguments");
}

// Counts how deep the calls are nested, so that no text can overflow the stack.
class Deeper {
 public:
  explicit Deeper(int& depth) : depth_(depth) { ++depth_; }
  ~Deeper() { --depth_; }
  Deeper(const Deeper&) = delete;
  Deeper& operator=(const Deeper&) = delete;

 private:
  int& depth_;
};

}  // namespace

void Parser::fail(const Token& token, std::string message, std::string hint) const {
  throw ExpressionError{count_characters(text_.substr(0, token.begin)) + 1,
                        std::max(1, count_characters(spelling(token))), std::move(message), std::move(hint)};
}

std::string_view Parser::spelling(const Token& token) const {
  return text_.substr(token.begin, token.end - token.begin);
}

std::size_t Parser::scan_number(std::size_t begin) {
  const auto skip_digits = [this](std::size_t i) {
    while (i < text_.size() && is_digit(text_[i])) ++i;
    return i;
  };
  std::size_t end = skip_digits(begin);
  if (end < text_.size() && text_[end] == '.') end = skip_digits(end + 1);
  if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
    std::size_t digits = end + 1;
    if (digits < text_.size() && (text_[digits] == '+' || text_[digits] == '-')) ++digits;
    const std::size_t exponent_end = skip_digits(digits);
    if (exponent_end > digits) end = exponent_end;  // else the e is a name: an operator is missing before it
  }
  return end;
}

void Parser::advance() {
  previous_ = token_;
  std::size_t begin = token_.end;
  while (begin < text_.size() && is_space(text_[begin])) ++begin;
  token_ = {Kind::end, begin, begin, 0.0};
  if (begin == text_.size()) return;
  const char first = text_[begin];
  if (is_digit(first) || (first == '.' && begin + 1 < text_.size() && is_digit(text_[begin + 1]))) {
    token_ = {Kind::number, begin, scan_number(begin), 0.0};
    const auto [rest, error] = std::from_chars(text_.data() + begin, text_.data() + token_.end, token_.value);
    if (error == std::errc::result_out_of_range) {
      fail(token_, "the number " + std::string(spelling(token_)) + " is outside the range of a double");
    }
    return;
  }
  std::size_t end = begin + 1;
  if (starts_name(first)) {
    while (end < text_.size() && continues_name(text_[end])) ++end;
    token_ = {Kind::name, begin, end, 0.0};
    return;
  }
  while (end < text_.size() && continues_character(text_[end])) ++end;
  token_ = {Kind::symbol, begin, end, 0.0};
}

bool Parser::at(std::string_view symbol) const {
  return token_.kind == Kind::symbol && spelling(token_) == symbol;
}

bool Parser::accept(std::string_view symbol) {
  if (!at(symbol)) return false;
  advance();
  return true;
}

Graph::Node Parser::parse() {
  if (text_.size() > Expression::longest_text) {
    fail({Kind::end, Expression::longest_text, Expression::longest_text, 0.0},
         "the expression is longer than " + std::to_string(Expression::longest_text) + " bytes");
  }
  advance();
  if (token_.kind == Kind::end) fail(token_, "the expression is empty");
  const Graph::Node result = sum();
  if (token_.kind != Kind::end) fail_at_token();
  return result;
}

// The token that follows a complete value can continue nothing.
void Parser::fail_at_token() const {
  const std::string found = token_.kind == Kind::end ? "the end" : quoted(spelling(token_));
  const bool value_follows = token_.kind == Kind::number || token_.kind == Kind::name || at("(");
  if (value_follows) fail(token_, "an operator is missing before " + found, missing_operator_hint());
  if (at(")")) fail(token_, "')' without a '('");
  fail(token_, "unexpected " + found,
       token_.kind == Kind::symbol ? hint_for_character(spelling(token_)) : "");
}

std::string Parser::missing_operator_hint() const {
  if (previous_.kind == Kind::symbol) return "write * to multiply";
  const std::string before(spelling(previous_));
  if (at("(")) return "write " + before + "*(...) to multiply";
  return "write " + before + "*" + std::string(spelling(token_)) + " to multiply";
}

Graph::Node Parser::sum() {
  Graph::Node left = product();
  while (true) {
    if (accept("+")) {
      left = graph_.apply(Operation::add, left, product());
    } else if (accept("-")) {
      left = graph_.apply(Operation::subtract, left, product());
    } else {
      return left;
    }
  }
}

Graph::Node Parser::product() {
  Graph::Node left = signed_value();
  while (true) {
    if (accept("*")) {
      if (at("*")) fail(token_, "unexpected '*'", "a power is written ^");
      left = graph_.apply(Operation::multiply, left, signed_value());
    } else if (accept("/")) {
      left = graph_.apply(Operation::divide, left, signed_value());
    } else {
      return left;
    }
  }
}

// Every cycle of the grammar comes through here.
Graph::Node Parser::signed_value() {
  const Deeper guard(depth_);
  if (depth_ > Expression::deepest_nesting) {
    fail(token_, "nested more than " + std::to_string(Expression::deepest_nesting) + " deep");
  }
  if (accept("-")) return graph_.apply(Operation::negate, signed_value());
  if (accept("+")) return signed_value();
  return power();
}

Graph::Node Parser::power() {
  const Graph::Node base = value();
  return accept("^") ? graph_.power(base, signed_value()) : base;
}

Graph::Node Parser::value() {
  if (token_.kind == Kind::number) {
    advance();
    return graph_.constant(previous_.value);
  }
  if (token_.kind == Kind::name) return name();
  if (accept("(")) {
    const Token opening = previous_;
    const Graph::Node inside = sum();
    close(opening);
    return inside;
  }
  if (token_.kind == Kind::end) fail(token_, "a value is missing at the end");
  fail(token_, "expected a value, found " + quoted(spelling(token_)), hint_for_character(spelling(token_)));
}

void Parser::close(const Token& opening) {
  if (accept(")")) return;
  if (token_.kind == Kind::end) fail(opening, "'(' is not closed");
  if (at(",")) fail(token_, "unexpected ','", "a decimal point is written .");
  fail_at_token();
}

Graph::Node Parser::name() {
  advance();
  const Token token = previous_;
  const std::string_view word = spelling(token);
  if (function_arity(word)) return call(token);
  if (const auto constant = named_constant(word)) return graph_.constant(*constant);
  const auto variable = variables_.find(word);
  if (!variable) fail_unknown(token);
  return graph_.variable(static_cast<std::uint32_t>(*variable));
}

void Parser::fail_unknown(const Token& name) const {
  std::vector<std::string> known = variables_.names();
  const std::vector<std::string> names = expression_names();
  known.insert(known.end(), names.begin(), names.end());
  const std::string nearest = nearest_name(spelling(name), known);
  fail(name, std::string(at("(") ? "unknown function " : "unknown name ") + quoted(spelling(name)),
       nearest.empty() ? "" : "did you mean " + quoted(nearest) + "?");
}

Graph::Node Parser::call(const Token& function) {
  const std::string_view word = spelling(function);
  const Arity arity = *function_arity(word);
  const std::vector<Graph::Node> given = arguments(function);
  if (given.size() < arity.least || given.size() > arity.most) {
    fail(function, quoted(word) + " takes " + describe(arity) + ", not " + std::to_string(given.size()));
  }
  return apply_function(graph_, word, given);
}

std::vector<Graph::Node> Parser::arguments(const Token& function) {
  const std::string word(spelling(function));
  if (!accept("(")) fail(function, quoted(word) + " is a function", "write " + word + "(...)");
  const Token opening = previous_;
  std::vector<Graph::Node> given;
  if (accept(")")) return given;
  do {
    given.push_back(sum());
  } while (accept(","));
  close(opening);
  return given;
}

}  // namespace backlight
