// Expressions of tests, by their text.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <variant>

#include "backlight/expression/expression.h"

namespace backlight::test {

/// Of x, y, z and t; a failure of the test, and empty, if the text is wrong.
inline Expression formula(const std::string& text) {
  auto parsed = Expression::parse(text, {"x", "y", "z", "t"});
  if (const auto* wrong = std::get_if<ExpressionError>(&parsed)) {
    ADD_FAILURE() << wrong->message;
    return {};
  }
  return std::get<Expression>(std::move(parsed));
}

}  // namespace backlight::test
