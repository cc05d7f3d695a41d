// What of a description depends on the image's time, and so must be evaluated anew for each image.
#pragma once

#include <string_view>
#include <vector>

#include "backlight/scene/description.h"
#include "backlight/scene/keys.h"

namespace backlight {

/// Decided by the variables that the formulas use, never by comparing values: a parameter depends on the time
/// where its formula uses t, frame, image_time, or a parameter that does. In the formula of a surface t is
/// the surface's own time, which rays bring with them; it does not count.
class TimeDependence {
 public:
  /// The description must outlive this.
  explicit TimeDependence(const Description& description);

  /// Whether any number within the node depends on the time. Entries called `but_for` are not looked at, at
  /// any depth.
  [[nodiscard]] bool changes(const Node& node, std::string_view but_for = {}) const;

  /// The same of a table with these keys, of which those of Clock::own have a t of their own.
  [[nodiscard]] bool changes(const Node& table, const KeyTable& keys) const;

 private:
  [[nodiscard]] bool changes(const Node& node, std::string_view but_for, bool own_time) const;
  /// `own_time`: t is not the image's.
  [[nodiscard]] bool changes(const Expression& expression, bool own_time) const;

  // By index into Description::variables: whether it depends on the image's time, t being so or not.
  std::vector<bool> of_t_, of_image_;
};

}  // namespace backlight
