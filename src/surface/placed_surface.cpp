#include "placed_surface.h"

#include <algorithm>
#include <cmath>

#include "backlight/surface/matter_motion.h"
#include "shape_table.h"

namespace backlight {
namespace {

/// Bounding radii are given this much more than their formulas, to cover the rounding of the formulas.
constexpr double slack = 1.0 + 1e-12;

constexpr LaneMatrix unit_matrix{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};

Extent extent_along(const LaneMatrix& m, int i) {
  const double x = std::abs(m.column[0][i]);
  const double y = std::abs(m.column[1][i]);
  const double z = std::abs(m.column[2][i]);
  return {std::hypot(x, z), std::hypot(x, y, z), x, y, z};
}

}  // namespace

PlacedSurface place(const Shape& shape, const Placement& placement) {
  PlacedSurface surface{shape, {}};
  LaneSurface& lanes = surface.lanes;
  // What comes and goes is asked crossing by crossing, whatever its form.
  lanes.kind = shape.presence ? ShapeKind::implicit : shape.kind;
  lanes.aligned = placement.local_from_rest() == Mat3(1.0) && placement.rest_from_local() == Mat3(1.0);
  const Vec3 scale = glm::abs(placement.scale());
  for (int c = 0; c < 3; ++c) {
    lanes.centre[c] = placement.position()[c];
    for (int r = 0; r < 3; ++r) {
      lanes.local_from_rest.column[c][r] = placement.local_from_rest()[c][r];
      lanes.rest_from_local.column[c][r] = placement.rest_from_local()[c][r];
    }
  }
  lanes.largest_scale = std::max({scale.x, scale.y, scale.z});
  lanes.radius = slack * methods(shape).bounding_radius(shape, scale);
  lanes.path = shape.motion ? shape.motion->path() : nullptr;
  lanes.is_carried = shape.motion && shape.motion->carriage() != nullptr;
  std::copy(shape.values.begin(), shape.values.end(), lanes.values);
  for (int i = 0; i < 3; ++i) {
    const Vec3 row{lanes.local_from_rest.column[0][i], lanes.local_from_rest.column[1][i],
                   lanes.local_from_rest.column[2][i]};
    lanes.stretch = std::max(lanes.stretch, std::abs(row.x) + std::abs(row.y) + std::abs(row.z));
    if (std::isfinite(lanes.radius))
      lanes.half[i] = methods(shape).half_extent(shape, extent_along(unit_matrix, i));
  }
  return surface;
}

AxisBox axis_box(const PlacedSurface& surface) {
  // Rounding of the centre's coordinates, and of a hit's, is covered too.
  const Vec3 centre = surface.position();
  const double margin = 1e-12 * surface.radius();
  AxisBox box;
  for (int i = 0; i < 3; ++i) {
    const Extent extent = extent_along(surface.lanes.rest_from_local, i);
    const double half =
        methods(surface.shape).half_extent(surface.shape, extent) + margin + 4e-16 * std::abs(centre[i]);
    box.lo[i] = centre[i] - half;
    box.hi[i] = centre[i] + half;
  }
  return box;
}

}  // namespace backlight
