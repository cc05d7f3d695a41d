// Constructive solid geometry: the crossings of all parts in their order along the line, and who is inside
// what between them. (S. D. Roth, "Ray casting for modeling solids", 1982.)
//
// The line comes re-origined at its closest approach to the whole; each part re-origins it once more, at its
// own centre, and so solves the same well-conditioned problem as if it stood alone.
#include <algorithm>
#include <cmath>

#include "csg_solid.h"
#include "csg_sweep.h"
#include "shape_table.h"
#include "surface_point.h"

namespace backlight {
namespace {

/// `part` of a crossing of the whole: the part of the leaf that was hit, and which leaf that is, and whether
/// its normal is turned.
constexpr int parts_of_leaf = 8;
constexpr int is_turned = parts_of_leaf;
constexpr int codes_of_leaf = 2 * parts_of_leaf;

// Sizes settle after the first few lines; from then on nothing is allocated.
Sweep::Scratch& scratch_of_thread() {
  thread_local Sweep::Scratch scratch;
  return scratch;
}

std::string problem_of(const Shape& shape) {
  return shape.solid ? std::string{} : std::string("an operation on solids needs at least one part");
}

double bounding_radius(const Shape& shape, const Vec3& factor) {
  const AxisBox& box = shape.solid->box();
  if (!(box.lo.x <= box.hi.x && box.lo.y <= box.hi.y && box.lo.z <= box.hi.z)) return 0.0;
  return glm::length(glm::max(glm::abs(box.lo), glm::abs(box.hi)) * factor);
}

double half_extent(const Shape& shape, const Extent& e) {
  const AxisBox& box = shape.solid->box();
  if (!(box.lo.x <= box.hi.x && box.lo.y <= box.hi.y && box.lo.z <= box.hi.z)) return 0.0;
  return glm::dot(glm::max(glm::abs(box.lo), glm::abs(box.hi)), Vec3{e.x, e.y, e.z});
}

Crossings crossings_of(const Shape& shape, const LocalLine& line, double lambda_min, Wanted /*wanted*/) {
  Crossings result;
  Sweep sweep(*shape.solid, line, parameter_of(line, lambda_min), scratch_of_thread());
  for (Sweep::Event event; result.count == 0 && sweep.next(event);) {
    if (!(line.lambda(event.t) > lambda_min)) continue;
    const int code = event.leaf * codes_of_leaf + (event.turned ? is_turned : 0) + event.crossing.part;
    result.list[result.count++] = {event.t, code, event.crossing.unresolved};
  }
  return result;
}

/// The crossing of a leaf that is at t along its line or, as rounding goes, next to it. That of a formula is
/// put onto its surface by surface_point anyhow.
Crossing crossing_at(const PlacedSurface& leaf, const LocalLine& line, const Crossing& near) {
  if (methods(leaf.shape).begin_walk != nullptr) return near;
  const Crossings found = crossings(leaf.shape, line, -infinite, Wanted::all);
  const auto* const nearest = std::min_element(
      found.list, found.list + found.count,
      [&](const Crossing& a, const Crossing& b) { return std::abs(a.t - near.t) < std::abs(b.t - near.t); });
  return nearest == found.list + found.count ? near : *nearest;
}

LocalPoint point_of(const Shape& shape, const LocalLine& line, const Crossing& crossing) {
  const Solid::Leaf& leaf = shape.solid->leaves()[static_cast<std::size_t>(crossing.part / codes_of_leaf)];
  const LocalLine part = local_line({line.point, line.direction, line.clock}, leaf.surface);
  const SurfacePoint point = surface_point(
      leaf.surface, part,
      crossing_at(leaf.surface, part,
                  {parameter_of(part, crossing.t), crossing.part % parts_of_leaf, crossing.unresolved}));
  LocalPoint result;
  result.position = point.position;
  const bool turned = (crossing.part & is_turned) != 0;
  result.gradient = leaf.subtracted != turned ? -point.normal : point.normal;
  result.u = point.u;
  result.v = point.v;
  result.error = point.error_bound;
  result.member = leaf.surface.shape.blend ? point.member : leaf.member;
  return result;
}

RootFinder finder_of(const Shape& /*shape*/) {
  return RootFinder::solid;
}

}  // namespace

const ShapeMethods csg_methods{.kind = ShapeKind::csg,
                               .name = "csg",
                               .encloses = true,
                               .problem = problem_of,
                               .bounding_radius = bounding_radius,
                               .half_extent = half_extent,
                               .crossings = crossings_of,
                               .point = point_of,
                               .finder = finder_of};

Shape csg(const SolidTree& tree) {
  Shape shape;
  shape.kind = ShapeKind::csg;
  shape.solid = std::make_shared<const Solid>(tree);
  return shape;
}

}  // namespace backlight
