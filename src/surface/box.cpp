#include "one_lane.h"

namespace backlight {
namespace {

Vec3 size_of(const Shape& shape) {
  return {shape.values[0], shape.values[1], shape.values[2]};
}

std::string problem_of(const Shape& shape) {
  const bool positive = unless_positive("", shape.values[0]).empty() &&
                        unless_positive("", shape.values[1]).empty() &&
                        unless_positive("", shape.values[2]).empty();
  return positive ? std::string{} : std::string("size must be three positive finite numbers");
}

double bounding_radius(const Shape& shape, const Vec3& factor) {
  return 0.5 * glm::length(size_of(shape) * factor);
}

double half_extent(const Shape& shape, const Extent& e) {
  return 0.5 * (shape.values[0] * e.x + shape.values[1] * e.y + shape.values[2] * e.z);
}

void texture(const Shape& shape, int part, LocalPoint& point) {
  const Vec3 f = point.position / size_of(shape);  // -1/2..1/2
  const double side = part % 2 == 0 ? -1.0 : 1.0;
  const int axis = part / 2;
  point.u = axis == 0 ? 0.5 - side * f.z : axis == 1 ? 0.5 + f.x : 0.5 + side * f.x;
  point.v = axis == 1 ? 0.5 + side * f.z : 0.5 - f.y;
}

int part_at(const Shape& shape, const Vec3& place) {
  const Vec3 f = glm::abs(place / size_of(shape));
  const int axis = f.x >= f.y && f.x >= f.z ? 0 : f.y >= f.z ? 1 : 2;
  return 2 * axis + (place[axis] < 0.0 ? 0 : 1);
}

}  // namespace

const ShapeMethods box_methods =
    form_methods<BoxForm, texture>(ShapeKind::box, "box", problem_of, bounding_radius, half_extent, part_at);

Shape box(Vec3 size) {
  return {ShapeKind::box, {size.x, size.y, size.z}, {}, {}, {}};
}

}  // namespace backlight
