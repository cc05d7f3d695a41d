// From a crossing to a point of the surface: position, normal, texture coordinates, error bound.
#pragma once

#include <span>

#include "backlight/surface/surface_set.h"
#include "placed_surface.h"
#include "shape_table.h"

namespace backlight {

/// `crossing`: one that the shape reported for the local line.
SurfacePoint surface_point(const PlacedSurface& surface, const LocalLine& line, const Crossing& crossing);

/// A point in local coordinates, but for what the surface's motion says of it.
SurfacePoint placed_point(const PlacedSurface& surface, const LocalPoint& point);

/// The same with that, at this time of the frame.
SurfacePoint surface_point(const PlacedSurface& surface, const LocalPoint& point, double time);
/// Of several points, each at its time.
void surface_points(const PlacedSurface& surface, std::span<LocalPoint> points, std::span<const double> times,
                    std::span<SurfacePoint> found);

/// What the motion of a surface that is not carried straight on says of the matter at some points, in local
/// coordinates: its own texture is what it takes along.
void add_motion(const PlacedSurface& surface, std::span<LocalPoint> points, std::span<const double> times);

}  // namespace backlight
