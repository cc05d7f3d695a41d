// Which bodies a place is in.
#pragma once

#include "backlight/surface/surface_set.h"

namespace backlight {

/// Whether a solid (is_solid of its shape) of the set, whose matter rests there, has this place inside. On
/// the surface itself either may be the answer.
bool encloses(const SurfaceSet& surfaces, int surface, const Vec3& place);

}  // namespace backlight
