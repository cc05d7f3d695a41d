// Cylinders and cones.
#include <algorithm>

#include "one_lane.h"

namespace backlight {
namespace {

std::string cylinder_problem(const Shape& shape) {
  return first_of(unless_positive("radius", shape.values[0]), unless_positive("height", shape.values[1]));
}

std::string cone_problem(const Shape& shape) {
  const double radius = shape.values[0];
  const double top_radius = shape.values[1];
  const auto fits = [](double value) { return value >= 0.0 && std::isfinite(value); };
  if (!fits(radius)) {
    return "radius must be finite and not negative";
  }
  if (!fits(top_radius)) {
    return "top_radius must be finite and not negative";
  }
  if (radius == 0.0 && top_radius == 0.0) {
    return "radius and top_radius must not both be zero";
  }
  return unless_positive("height", shape.values[2]);
}

/// Radius at the bottom, at the top, and the height.
struct Frustum {
  double bottom;
  double top;
  double height;
};

Frustum frustum_of(const Shape& shape) {
  const auto& value = shape.values;
  return shape.kind == ShapeKind::cylinder ? Frustum{value[0], value[0], value[1]}
                                           : Frustum{value[0], value[1], value[2]};
}

double bounding_radius(const Shape& shape, const Vec3& factor) {
  const Frustum f = frustum_of(shape);
  return std::hypot(std::max(f.bottom, f.top) * std::max(factor.x, factor.z), 0.5 * f.height * factor.y);
}

double half_extent(const Shape& shape, const Extent& e) {
  const Frustum f = frustum_of(shape);
  return std::max(f.bottom, f.top) * e.circle + 0.5 * f.height * e.y;
}

void texture(const Shape& shape, int part, LocalPoint& point) {
  const auto [bottom, top, height] = frustum_of(shape);
  const Vec3& on = point.position;
  if (part == 0) {
    point.u = longitude(on.x, on.z);
    point.v = 0.5 - on.y / height;
  } else {
    texture_of_disc(part == 2 ? top : bottom, part == 2 ? 1.0 : -1.0, point);
  }
}

/// A place on the side is as far from the slanted line as it is from the caps, or farther out.
int part_at(const Shape& shape, const Vec3& place) {
  const auto [bottom, top, height] = frustum_of(shape);
  const double up = place.y / height + 0.5;
  const double slope = std::hypot(height, top - bottom);
  const double aside =
      std::abs(std::hypot(place.x, place.z) - (bottom + (top - bottom) * up)) * height / slope;
  const double to_cap = height * std::min(std::abs(up), std::abs(1.0 - up));
  return aside <= to_cap ? 0 : up < 0.5 ? 1 : 2;
}

}  // namespace

const ShapeMethods cylinder_methods = form_methods<FrustumForm<true>, texture>(
    ShapeKind::cylinder, "cylinder", cylinder_problem, bounding_radius, half_extent, part_at);
const ShapeMethods cone_methods = form_methods<FrustumForm<false>, texture>(
    ShapeKind::cone, "cone", cone_problem, bounding_radius, half_extent, part_at);

Shape cylinder(double radius, double height) {
  return {ShapeKind::cylinder, {radius, height}, {}, {}, {}};
}

Shape cone(double radius, double top_radius, double height) {
  return {ShapeKind::cone, {radius, top_radius, height}, {}, {}, {}};
}

}  // namespace backlight
