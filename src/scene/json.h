// Just enough JSON to write a schema: values that keep the order of their members.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace backlight {

/// A JSON value, as text. Objects keep the order in which members were added.
class Json {
 public:
  static Json text(std::string_view value);
  static Json number(double value);
  static Json boolean(bool value);
  static Json array(const std::vector<Json>& elements);
  static Json object() { return {}; }

  /// Adds a member to an object.
  Json& add(std::string_view name, Json value);
  [[nodiscard]] bool empty_object() const { return literal_.empty() && members_.empty(); }

  /// Indented by two spaces a level, without a newline at the end.
  [[nodiscard]] std::string write(int level = 0) const;

 private:
  std::string literal_;  // of anything but an object or array
  std::vector<std::pair<std::string, Json>> members_;
  std::vector<Json> elements_;
  bool is_array_ = false;
};

}  // namespace backlight
