// Constructive solid geometry: the crossings of all parts in their order along the line, and who is inside
// what between them. (S. D. Roth, "Ray casting for modeling solids", 1982.)
//
// The line comes re-origined at its closest approach to the whole; each part re-origins it once more, at its
// own centre, and so solves the same well-conditioned problem as if it stood alone.
#include <algorithm>
#include <cmath>

#include "csg_sheet.h"
#include "csg_solid.h"
#include "shape_table.h"
#include "surface_point.h"

namespace backlight {
namespace {

/// `part` of a crossing of the whole: the part of the leaf that was hit, and which leaf that is, and whether
/// its normal is turned.
constexpr int parts_of_leaf = 8;
constexpr int is_turned = parts_of_leaf;
constexpr int codes_of_leaf = 2 * parts_of_leaf;

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

void first_crossings_of(const Shape& shape, const LocalLines& lines, double lambda_min,
                        std::span<FirstOnLine> results) {
  Sweep::Event first[LocalLines::most];
  first_of_solid(*shape.solid, lines, lambda_min, {first, lines.count});
  for (std::size_t i = 0; i < lines.count; ++i) {
    const Sweep::Event& event = first[i];
    results[i] = {};
    if (!(event.t < infinite)) continue;
    const Solid::Leaf& leaf = shape.solid->leaves()[static_cast<std::size_t>(event.leaf)];
    const int part = methods(leaf.surface.shape).has_many_parts ? 0 : event.crossing.part;
    const int code = event.leaf * codes_of_leaf + (event.turned ? is_turned : 0) + part;
    results[i] = {event.t, event.crossing.unresolved, code};
  }
}

void blocks(const Shape& shape, const LocalLines& lines, double lambda_min, double lambda_max,
            std::span<bool> results) {
  FirstOnLine first[LocalLines::most];
  first_crossings_of(shape, lines, lambda_min, {first, lines.count});
  for (std::size_t i = 0; i < lines.count; ++i) results[i] = lines.lambda(i, first[i].t) < lambda_max;
}

Crossing crossing_of_walk(const PlacedSurface& leaf, const LocalLine& line, const Crossing& near) {
  SolidWalk walk;
  methods(leaf.shape).begin_walk(leaf.shape, line, -infinite, Stretch{}, walk);
  Crossing nearest = near;
  double least = infinite;
  for (SolidWalk::Event event; walk.next(event);) {
    const double off = std::abs(event.crossing.t - near.t);
    if (!(off < least)) continue;
    least = off;
    nearest = event.crossing;
  }
  return nearest;
}

/// The crossing of a leaf that is at t along its line or, as rounding goes, next to it. That of a formula is
/// put onto its surface by surface_point anyhow.
Crossing crossing_at(const PlacedSurface& leaf, const LocalLine& line, const Crossing& near) {
  if (methods(leaf.shape).has_many_parts) return crossing_of_walk(leaf, line, near);
  if (methods(leaf.shape).begin_walk != nullptr) return near;
  const Crossings found = crossings(leaf.shape, line, -infinite, Wanted::all);
  const auto* const nearest = std::min_element(
      found.list, found.list + found.count,
      [&](const Crossing& a, const Crossing& b) { return std::abs(a.t - near.t) < std::abs(b.t - near.t); });
  return nearest == found.list + found.count ? near : *nearest;
}

/// The crossings of one leaf, each on a line of its own.
struct OnLeaf {
  std::size_t index[LocalLines::most];  ///< among those of the whole
  LocalLines lines;
  Crossing crossings[LocalLines::most];
  LocalPoint points[LocalLines::most];

  void add(std::size_t i, const LocalLine& line, const Crossing& crossing) {
    index[lines.count] = i;
    crossings[lines.count] = crossing;
    lines.add(line);
  }
};

void find_points(const PlacedSurface& leaf, TextureCoordinates wanted, OnLeaf& on) {
  const std::size_t count = on.lines.count;
  if (methods(leaf.shape).has_many_parts) {
    for (std::size_t k = 0; k < count; ++k)
      on.crossings[k] = crossing_at(leaf, on.lines.line(k), on.crossings[k]);
  }
  if (const auto many = methods(leaf.shape).points; many != nullptr) {
    return many(leaf.shape, on.lines, {on.crossings, count}, wanted, {on.points, count});
  }
  for (std::size_t k = 0; k < count; ++k) {
    const LocalLine line = on.lines.line(k);
    on.points[k] = methods(leaf.shape).point(leaf.shape, line, crossing_at(leaf, line, on.crossings[k]));
    if (wanted == TextureCoordinates::unwanted) on.points[k].u = on.points[k].v = 0.0;
  }
}

/// A leaf's point as one of the whole.
LocalPoint of_whole(const Solid::Leaf& leaf, const SurfacePoint& point, bool turned) {
  LocalPoint result;
  result.position = point.position;
  result.gradient = leaf.subtracted != turned ? -point.normal : point.normal;
  if (is_smooth(leaf.surface.shape))
    result.shading = leaf.subtracted != turned ? -point.shading_normal : point.shading_normal;
  result.u = point.u;
  result.v = point.v;
  result.error = point.error_bound;
  result.member = leaf.surface.shape.blend ? point.member : leaf.member + point.member;
  result.moves = point.moves;
  result.velocity = point.velocity;
  result.own_time = point.own_time;
  return result;
}

/// Leaf by leaf.
void points_of(const Shape& shape, const LocalLines& lines, std::span<const Crossing> crossings,
               TextureCoordinates wanted, std::span<LocalPoint> points) {
  const auto leaf_of = [&](std::size_t i) { return crossings[i].part / codes_of_leaf; };
  bool done[LocalLines::most]{};
  OnLeaf on;
  for (std::size_t first = 0; first < lines.count; ++first) {
    if (done[first]) continue;
    const Solid::Leaf& leaf = shape.solid->leaves()[static_cast<std::size_t>(leaf_of(first))];
    on.lines.count = 0;
    for (std::size_t i = first; i < lines.count; ++i) {
      if (done[i] || leaf_of(i) != leaf_of(first)) continue;
      done[i] = true;
      const LocalLine line = lines.line(i);
      const LocalLine part = local_line({line.point, line.direction, line.clock}, leaf.surface);
      on.add(
          i, part,
          {parameter_of(part, crossings[i].t), crossings[i].part % parts_of_leaf, crossings[i].unresolved});
    }
    find_points(leaf.surface, wanted, on);
    double times[LocalLines::most];
    SurfacePoint found[LocalLines::most];
    const std::size_t count = on.lines.count;
    for (std::size_t k = 0; k < count; ++k)
      times[k] = on.lines.clock_start[k] + on.crossings[k].t * on.lines.clock_rate[k];
    surface_points(leaf.surface, {on.points, count}, {times, count}, {found, count});
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = on.index[k];
      points[i] = of_whole(leaf, found[k], (crossings[i].part & is_turned) != 0);
    }
  }
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
                               .crossings = crossings_of_one,
                               .point = point_of_one,
                               .first_crossings = first_crossings_of,
                               .finder = finder_of,
                               .points = points_of,
                               .blocks = blocks};

Shape csg(const SolidTree& tree) {
  Shape shape;
  shape.kind = ShapeKind::csg;
  shape.solid = std::make_shared<const Solid>(tree);
  return shape;
}

}  // namespace backlight
