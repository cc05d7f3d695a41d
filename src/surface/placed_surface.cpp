#include "placed_surface.h"

#include <cmath>

#include "shape_table.h"

namespace backlight {
namespace {

/// Bounding radii are given this much more than their formulas, to cover the rounding of the formulas.
constexpr double slack = 1.0 + 1e-12;

Extent extent_along(const Mat3& m, int i) {
  const double x = std::abs(m[0][i]);
  const double y = std::abs(m[1][i]);
  const double z = std::abs(m[2][i]);
  return {std::hypot(x, z), std::hypot(x, y, z), x, y, z};
}

}  // namespace

PlacedSurface place(const Shape& shape, const Placement& placement) {
  const bool aligned = placement.local_from_rest() == Mat3(1.0) && placement.rest_from_local() == Mat3(1.0);
  return {shape, placement, slack * methods(shape).bounding_radius(shape, glm::abs(placement.scale())),
          aligned};
}

AxisBox axis_box(const PlacedSurface& surface) {
  // Rounding of the centre's coordinates, and of a hit's, is covered too.
  const Vec3& centre = surface.placement.position();
  const double margin = 1e-12 * surface.radius;
  AxisBox box;
  for (int i = 0; i < 3; ++i) {
    const double half =
        methods(surface.shape)
            .half_extent(surface.shape, extent_along(surface.placement.rest_from_local(), i)) +
        margin + 4e-16 * std::abs(centre[i]);
    box.lo[i] = centre[i] - half;
    box.hi[i] = centre[i] + half;
  }
  return box;
}

}  // namespace backlight
