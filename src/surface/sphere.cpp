#include <algorithm>
#include <numbers>

#include "one_lane.h"

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

void texture(const Shape& /*shape*/, int /*part*/, LocalPoint& point) {
  const Vec3& on = point.position;
  point.u = longitude(on.x, on.z);
  point.v = std::atan2(std::hypot(on.x, on.z), on.y) * std::numbers::inv_pi;
}

}  // namespace

const ShapeMethods sphere_methods =
    form_methods<SphereForm, texture>(ShapeKind::sphere, "sphere", problem_of, bounding_radius, half_extent);

Shape sphere(double radius) {
  return {ShapeKind::sphere, {radius}, {}, {}, {}};
}

}  // namespace backlight
