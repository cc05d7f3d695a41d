// Where along a line a surface that moves can be.
#pragma once

#include "backlight/surface/matter_motion.h"
#include "convex.h"
#include "local_line.h"

namespace backlight {

/// A stretch of the line outside which it is not in the motion's ball: docs/physics.md equation (28). For
/// light and for lines of one moment alike.
Stretch inside_ball(const MatterMotion& motion, const LocalLine& line);

}  // namespace backlight
