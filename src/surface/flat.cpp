// Disks and planes.
#include <algorithm>

#include "one_lane.h"

namespace backlight {
namespace {

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

void disk_texture(const Shape& shape, int /*part*/, LocalPoint& point) {
  texture_of_disc(shape.values[0], 1.0, point);
}

}  // namespace

const ShapeMethods disk_methods = form_methods<FlatForm<true>, disk_texture>(
    ShapeKind::disk, "disk", disk_problem, disk_radius, disk_extent);
const ShapeMethods plane_methods = form_methods<FlatForm<false>, texture_of_place>(
    ShapeKind::plane, "plane", plane_problem, no_radius, no_extent);

Shape disk(double radius) {
  return {ShapeKind::disk, {radius}, {}, {}, {}};
}

Shape plane() {
  return {ShapeKind::plane, {}, {}, {}, {}};
}

}  // namespace backlight
