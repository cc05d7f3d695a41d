// From a crossing to a point of the surface: position, normal, texture coordinates, error bound.
#pragma once

#include "backlight/surface/surface_set.h"
#include "placed_surface.h"

namespace backlight {

/// `local`: the crossing in local coordinates, near the surface to rounding; `part`: the face it is on.
SurfacePoint surface_point(const PlacedSurface& surface, const Vec3& local, int part);

}  // namespace backlight
