#include "convex.h"

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

Crossings crossings_of(const Shape& shape, const LocalLine& line, double /*lambda_min*/, Wanted /*wanted*/) {
  const Vec3 half = 0.5 * size_of(shape);
  Stretch stretch;
  for (int axis = 0; axis < 3; ++axis) {
    narrow_to_slab(stretch, line.point[axis], line.direction[axis], half[axis], 2 * axis);
  }
  return stretch.ends();
}

LocalPoint point_of(const Shape& shape, const LocalLine& line, const Crossing& crossing) {
  const Vec3 size = size_of(shape);
  const Vec3 p = line.at(crossing.t);
  const int part = crossing.part;
  const Vec3 half = 0.5 * size;
  const int axis = part / 2;
  const double side = part % 2 == 0 ? -1.0 : 1.0;
  Vec3 on = glm::clamp(p, -half, half);
  on[axis] = side * half[axis];
  Vec3 normal{0.0};
  normal[axis] = side;
  const Vec3 f = on / size;  // -1/2..1/2
  switch (axis) {
    case 0:
      return {on, normal, 0.5 - side * f.z, 0.5 - f.y};
    case 1:
      return {on, normal, 0.5 + f.x, 0.5 + side * f.z};
    default:
      return {on, normal, 0.5 + side * f.x, 0.5 - f.y};
  }
}

}  // namespace

const ShapeMethods box_methods{ShapeKind::box, "box",        true,     problem_of, bounding_radius,
                               half_extent,    crossings_of, point_of, nullptr};

Shape box(Vec3 size) {
  return {ShapeKind::box, {size.x, size.y, size.z}, {}};
}

}  // namespace backlight
