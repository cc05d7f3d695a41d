// Surfaces that are there at some times only.
#pragma once

#include "backlight/surface/surface_set.h"
#include "local_line.h"

namespace backlight {

/// The first crossing beyond λ = 0 at which the surface, which has a presence, is there.
Hit first_present(const PlacedSurface& surface, int index, const LocalLine& line);

}  // namespace backlight
