// Disks and planes.
#include <algorithm>

#include "shape_table.h"

namespace backlight {
namespace {

/// y = 0 inside `radius`.
Crossings flat_crossings(double radius, const LocalLine& line) {
  Crossings result;
  if (line.direction.y != 0.0) {
    const double t = -line.point.y / line.direction.y;
    const Vec3 p = line.at(t);
    if (p.x * p.x + p.z * p.z <= radius * radius) {
      result.add(t, 0);
    }
  }
  return result;
}

std::string disk_problem(const Shape& shape) {
  return unless_positive("radius", shape.values[0]);
}

std::string plane_problem(const Shape& /*shape*/) {
  return {};
}

double disk_radius(const Shape& shape, const Vec3& factor) {
  return shape.values[0] * std::max(factor.x, factor.z);
}

double no_radius(const Shape& /*shape*/, const Vec3& /*factor*/) {
  return infinite;
}

double disk_extent(const Shape& shape, const Extent& e) {
  return shape.values[0] * e.circle;
}

double no_extent(const Shape& /*shape*/, const Extent& /*e*/) {
  return infinite;
}

Crossings disk_crossings(const Shape& shape, const LocalLine& line, double /*lambda_min*/,
                         Wanted /*wanted*/) {
  return flat_crossings(shape.values[0], line);
}

Crossings plane_crossings(const Shape& /*shape*/, const LocalLine& line, double /*lambda_min*/,
                          Wanted /*wanted*/) {
  Crossings result = flat_crossings(infinite, line);
  const double below = result.count > 0 ? -line.direction.y : line.point.y;
  result.inside_before = below < 0.0;  // the solid is the half-space y < 0
  return result;
}

LocalPoint disk_point(const Shape& shape, const LocalLine& line, const Crossing& crossing) {
  return on_disc(shape.values[0], 0.0, 1.0, line.at(crossing.t));
}

LocalPoint plane_point(const Shape& /*shape*/, const LocalLine& line, const Crossing& crossing) {
  const Vec3 p = line.at(crossing.t);
  return {{p.x, 0.0, p.z}, {0.0, 1.0, 0.0}, p.x, p.z};
}

}  // namespace

const ShapeMethods disk_methods{ShapeKind::disk, "disk",         false,      disk_problem, disk_radius,
                                disk_extent,     disk_crossings, disk_point, nullptr};
const ShapeMethods plane_methods{ShapeKind::plane, "plane",         true,        plane_problem, no_radius,
                                 no_extent,        plane_crossings, plane_point, nullptr};

Shape disk(double radius) {
  return {ShapeKind::disk, {radius}, {}};
}

Shape plane() {
  return {ShapeKind::plane, {}, {}};
}

}  // namespace backlight
