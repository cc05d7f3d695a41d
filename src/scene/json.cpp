#include "json.h"

#include <cstdio>

#include "backlight/scene/keys.h"

namespace backlight {
namespace {

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20U) {
      char buffer[8];
      std::snprintf(buffer, sizeof buffer, "\\u%04x", static_cast<unsigned>(c));
      out += buffer;
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string indent(int level) {
  return std::string(static_cast<std::size_t>(level) * 2, ' ');
}

}  // namespace

Json Json::text(std::string_view value) {
  Json json;
  json.literal_ = quoted(value);
  return json;
}

Json Json::number(double value) {
  Json json;
  json.literal_ = number_text(value);
  return json;
}

Json Json::boolean(bool value) {
  Json json;
  json.literal_ = value ? "true" : "false";
  return json;
}

Json Json::array(const std::vector<Json>& elements) {
  Json json;
  json.elements_ = elements;
  json.is_array_ = true;
  return json;
}

Json& Json::add(std::string_view name, Json value) {
  members_.emplace_back(std::string(name), std::move(value));
  return *this;
}

std::string Json::write(int level) const {
  if (!literal_.empty()) return literal_;
  std::string out = is_array_ ? "[" : "{";
  const std::string_view close = is_array_ ? "]" : "}";
  if (elements_.empty() && members_.empty()) return out + std::string(close);
  std::string_view separator = "\n";
  for (const Json& element : elements_) {
    out += std::string(separator) + indent(level + 1) + element.write(level + 1);
    separator = ",\n";
  }
  for (const auto& [name, value] : members_) {
    out += std::string(separator) + indent(level + 1) + quoted(name) + ": " + value.write(level + 1);
    separator = ",\n";
  }
  return out + "\n" + indent(level) + std::string(close);
}

}  // namespace backlight
