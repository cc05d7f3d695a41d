#include <algorithm>
#include <numbers>

#include "shape_table.h"

namespace backlight {
namespace {

std::string problem_of(const Shape& shape) {
  return unless_positive("radius", shape.values[0]);
}

double bounding_radius(const Shape& shape, const Vec3& factor) {
  return shape.values[0] * std::max({factor.x, factor.y, factor.z});
}

double half_extent(const Shape& shape, const Extent& e) {
  return shape.values[0] * e.sphere;
}

Crossings crossings_of(const Shape& shape, const LocalLine& line, double /*lambda_min*/, Wanted /*wanted*/) {
  const double radius = shape.values[0];
  // Pythagoras on the perpendicular: no difference of squares of the distance to the viewer.
  const double square = radius * radius - glm::dot(line.point, line.point);
  Crossings result;
  if (square >= 0.0) {
    const double half_chord = std::sqrt(square);
    result.add(-half_chord, 0);
    result.add(half_chord, 0);
  }
  return result;
}

LocalPoint point_of(const Shape& shape, const LocalLine& line, const Crossing& crossing) {
  const Vec3 p = line.at(crossing.t);
  const double inverse = 1.0 / glm::length(p);
  const Vec3 outward = p * inverse;
  const Vec3 on = p * (shape.values[0] * inverse);
  LocalPoint point{on, outward, longitude(on.x, on.z),
                   std::atan2(std::hypot(on.x, on.z), on.y) * std::numbers::inv_pi};
  point.is_unit = true;
  return point;
}

}  // namespace

const ShapeMethods sphere_methods{ShapeKind::sphere, "sphere",     true,     problem_of, bounding_radius,
                                  half_extent,       crossings_of, point_of, nullptr};

Shape sphere(double radius) {
  return {ShapeKind::sphere, {radius}, {}};
}

}  // namespace backlight
