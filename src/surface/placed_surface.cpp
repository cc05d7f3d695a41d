#include "placed_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace backlight {
namespace {

/// Bounding radii are given this much more than their formulas, to cover the rounding of the formulas.
constexpr double slack = 1.0 + 1e-12;

double bounding_radius(const Shape& shape, const Vec3& scale) {
  const auto& value = shape.values;
  const Vec3 factor = glm::abs(scale);
  const double across = std::max(factor.x, factor.z);
  switch (shape.kind) {
    case ShapeKind::sphere:
      return value[0] * std::max(across, factor.y);
    case ShapeKind::box:
      return 0.5 * glm::length(Vec3{value[0], value[1], value[2]} * factor);
    case ShapeKind::cylinder:
      return std::hypot(value[0] * across, 0.5 * value[1] * factor.y);
    case ShapeKind::cone:
      return std::hypot(std::max(value[0], value[1]) * across, 0.5 * value[2] * factor.y);
    case ShapeKind::torus:
      return factor.y <= across ? (value[0] + value[1]) * across
                                : std::hypot((value[0] + value[1]) * across, value[1] * factor.y);
    case ShapeKind::disk:
      return value[0] * across;
    case ShapeKind::plane:
    case ShapeKind::quadric:
      break;
  }
  return std::numeric_limits<double>::infinity();
}

/// Half the extent along rest axis `i` of a circle of radius 1 about the local y axis, of a unit sphere, ...
struct Extent {
  double circle;
  double sphere;
  double x, y, z;  ///< of the local unit vectors
};

Extent extent_along(const Mat3& m, int i) {
  const double x = std::abs(m[0][i]);
  const double y = std::abs(m[1][i]);
  const double z = std::abs(m[2][i]);
  return {std::hypot(x, z), std::hypot(x, y, z), x, y, z};
}

double half_extent(const Shape& shape, const Extent& e) {
  const auto& value = shape.values;
  switch (shape.kind) {
    case ShapeKind::sphere:
      return value[0] * e.sphere;
    case ShapeKind::box:
      return 0.5 * (value[0] * e.x + value[1] * e.y + value[2] * e.z);
    case ShapeKind::cylinder:
      return value[0] * e.circle + 0.5 * value[1] * e.y;
    case ShapeKind::cone:
      return std::max(value[0], value[1]) * e.circle + 0.5 * value[2] * e.y;
    case ShapeKind::torus:
      return value[0] * e.circle + value[1] * e.sphere;
    case ShapeKind::disk:
      return value[0] * e.circle;
    case ShapeKind::plane:
    case ShapeKind::quadric:
      break;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

PlacedSurface place(const Shape& shape, const Placement& placement) {
  return {shape, placement, slack * bounding_radius(shape, placement.scale())};
}

AxisBox axis_box(const PlacedSurface& surface) {
  // Rounding of the centre's coordinates, and of a hit's, is covered too.
  const Vec3& centre = surface.placement.position();
  const double margin = 1e-12 * surface.radius;
  AxisBox box;
  for (int i = 0; i < 3; ++i) {
    const double half = half_extent(surface.shape, extent_along(surface.placement.rest_from_local(), i)) +
                        margin + 4e-16 * std::abs(centre[i]);
    box.lo[i] = centre[i] - half;
    box.hi[i] = centre[i] + half;
  }
  return box;
}

}  // namespace backlight
