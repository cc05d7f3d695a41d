// What of a description depends on the image's time, and so must be evaluated anew for each image.
#pragma once

#include <string_view>
#include <vector>

#include "backlight/scene/description.h"

namespace backlight {

/// Decided by the variables that the formulas use, never by comparing values: a parameter depends on the time
/// where its formula uses t, frame, or a parameter that does. In the formula of a surface t is the surface's
/// own time, which rays bring with them; it does not count.
class TimeDependence {
 public:
  /// The description must outlive this.
  explicit TimeDependence(const Description& description);

  /// Whether any number within the node depends on the time. Entries called `but_for` are not looked at, at
  /// any depth.
  [[nodiscard]] bool changes(const Node& node, std::string_view but_for = {}) const;

 private:
  [[nodiscard]] bool changes(const Expression& expression) const;

  std::vector<bool> variable_changes_;  // by index into Description::variables
};

}  // namespace backlight
