#include "backlight/base/json_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace backlight {
namespace {

// Length of the well-formed UTF-8 character at the start of `text`; 0 if there is none. Overlong forms,
// surrogates and values past U+10FFFF are not well-formed (Unicode 15, table 3-7).
std::size_t character_length(std::string_view text) {
  const auto byte = [text](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const auto continues = [byte](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
  const unsigned first = byte(0);
  if (first < 0x80U) return 1;
  if (first >= 0xC2U && first <= 0xDFU) return continues(1) ? 2 : 0;
  if (first >= 0xE0U && first <= 0xEFU) {
    const unsigned low = first == 0xE0U ? 0xA0U : 0x80U;
    const unsigned high = first == 0xEDU ? 0x9FU : 0xBFU;
    return byte(1) >= low && byte(1) <= high && continues(2) ? 3 : 0;
  }
  if (first >= 0xF0U && first <= 0xF4U) {
    const unsigned low = first == 0xF0U ? 0x90U : 0x80U;
    const unsigned high = first == 0xF4U ? 0x8FU : 0xBFU;
    return byte(1) >= low && byte(1) <= high && continues(2) && continues(3) ? 4 : 0;
  }
  return 0;
}

std::string escaped(char c) {
  switch (c) {
    case '"':
      return "\\\"";
    case '\\':
      return "\\\\";
    case '\n':
      return "\\n";
    case '\t':
      return "\\t";
    case '\r':
      return "\\r";
    default:
      break;
  }
  if (static_cast<unsigned char>(c) >= 0x20U) return {c};
  std::array<char, 8> code{};
  std::snprintf(code.data(), code.size(), "\\u%04x", static_cast<unsigned>(static_cast<unsigned char>(c)));
  return code.data();
}

constexpr const char* replacement = "\xEF\xBF\xBD";  // U+FFFD

std::string of_xml(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    default:
      break;
  }
  const bool is_text = static_cast<unsigned char>(c) >= 0x20U || c == '\n' || c == '\t';
  return is_text ? std::string{c} : replacement;
}

// The text with its single bytes written by `write`, and what is no UTF-8 replaced.
template <typename Write>
std::string rewritten(std::string_view text, const Write& write) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length == 1) {
      result += write(text.front());
    } else {
      result += length == 0 ? replacement : text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return result;
}

}  // namespace

std::string json_quoted(std::string_view text) {
  return '"' + rewritten(text, escaped) + '"';
}

std::string xml_escaped(std::string_view text) {
  return rewritten(text, of_xml);
}

std::string json_number(double value) {
  if (!std::isfinite(value)) return "null";
  std::array<char, 32> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return {digits.data(), result.ptr};
}

}  // namespace backlight
