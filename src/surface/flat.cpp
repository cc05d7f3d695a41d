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

const ShapeMethods disk_methods{.kind = ShapeKind::disk,
                                .name = "disk",
                                .encloses = false,
                                .is_convex = true,
                                .is_flat = true,
                                .problem = disk_problem,
                                .bounding_radius = disk_radius,
                                .half_extent = disk_extent,
                                .crossings = crossings_by<FlatForm<true>>,
                                .point = point_by<FlatForm<true>, disk_texture>,
                                .texture = disk_texture};
const ShapeMethods plane_methods{.kind = ShapeKind::plane,
                                 .name = "plane",
                                 .encloses = true,
                                 .is_convex = true,
                                 .is_flat = true,
                                 .problem = plane_problem,
                                 .bounding_radius = no_radius,
                                 .half_extent = no_extent,
                                 .crossings = crossings_by<FlatForm<false>>,
                                 .point = point_by<FlatForm<false>, texture_of_place>,
                                 .texture = texture_of_place};

Shape disk(double radius) {
  return {ShapeKind::disk, {radius}, {}, {}, {}};
}

Shape plane() {
  return {ShapeKind::plane, {}, {}, {}, {}};
}

}  // namespace backlight
