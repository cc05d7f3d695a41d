// Motions that leave a surface where it is.
#pragma once

#include <optional>
#include <vector>

#include "backlight/surface/placement.h"
#include "motion_levels.h"

namespace backlight {

/// The levels with the angles that depend on t put to 0.
std::vector<MotionLevel> at_rest(std::vector<MotionLevel> levels);

/// Of levels whose angles alone depend on t, which are put to 0; nothing for others.
std::optional<Placement> placement_at_rest(const std::vector<MotionLevel>& levels);

/// Whether all that moves is one angle, and the shape with all that is within it is a surface of revolution
/// about that axis (a sphere about any line through its centre).
bool turns_in_itself(const Shape& shape, const std::vector<MotionLevel>& levels);

}  // namespace backlight
