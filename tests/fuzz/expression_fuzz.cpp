// libFuzzer entry: any bytes are an expression or an error whose caret lies in the text.
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "backlight/expression/expression.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto result = backlight::Expression::parse(text, {"t", "frame", "x"});
  if (const auto* error = std::get_if<backlight::ExpressionError>(&result)) {
    const bool inside = error->column >= 1 && static_cast<std::size_t>(error->column) <= size + 1;
    if (!inside || error->length < 1 || error->message.empty()) std::abort();
    return 0;
  }
  const auto& expression = std::get<backlight::Expression>(result);
  const double value = expression.evaluate(std::vector<double>{0.5, 2.0, -1.0});
  const auto constant = expression.constant();
  if (constant && *constant != value && value == value) std::abort();
  return 0;
}
