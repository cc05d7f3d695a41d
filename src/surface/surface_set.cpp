#include "backlight/surface/surface_set.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "backlight/surface/matter_motion.h"
#include "csg_solid.h"
#include "hierarchy.h"
#include "local_line.h"
#include "moving_ball.h"
#include "passing_lanes.h"
#include "presence.h"
#include "shape_table.h"
#include "surface_point.h"
#include "walk.h"

namespace backlight {
namespace {

/// The ray in coordinates that go along with a surface that is carried straight on: there it is at rest.
RestRay along_with(const PlacedSurface& surface, const RestRay& ray) {
  if (!surface.lanes.is_carried) return ray;
  const Vec3& velocity = *surface.shape.motion->carriage();
  return {ray.origin - ray.clock.start * velocity, ray.direction - ray.clock.rate * velocity, ray.clock};
}

/// The first crossing of a line beyond λ = 0.
Hit first_of(const Crossings& found, const LocalLine& line, int surface) {
  for (int i = 0; i < found.count; ++i) {
    const double lambda = line.lambda(found.list[i].t);
    if (lambda > 0.0) return {lambda, surface, found.list[i].part, found.list[i].unresolved, found.list[i].t};
  }
  return {};
}

Hit first_crossing(const PlacedSurface& surface, int index, const RestRay& given) {
  const RestRay ray = along_with(surface, given);
  if (surface.shape.presence) return first_present(surface, index, local_line(ray, surface));
  if (surface.shape.kind == ShapeKind::plane) {
    const double lambda = plane_lambda(surface.lanes, one_lane(ray)).v;
    return lambda > 0.0 && lambda < infinite ? Hit{lambda, index} : Hit{};
  }
  const LocalLine line = local_line(ray, surface);
  return first_of(crossings(surface.shape, line, 0.0, Wanted::first), line, index);
}

/// Whether the ray meets the surface at a λ in (0, lambda_max).
bool is_blocked_by(const PlacedSurface& surface, const RestRay& ray, double lambda_max) {
  const auto blocks = methods(surface.shape).blocks;
  if (blocks == nullptr || surface.shape.presence) return first_crossing(surface, 0, ray).lambda < lambda_max;
  LocalLines line;
  line.add(local_line(along_with(surface, ray), surface));
  bool result = false;
  blocks(surface.shape, line, 0.0, lambda_max, {&result, 1});
  return result;
}

/// Whether it fits into no sphere at rest.
bool is_unbounded(const PlacedSurface& surface) {
  return std::isinf(surface.radius());
}

void put(RaySheet& sheet, const Vec3& origin, const Vec3& direction, const RayClock& clock) {
  sheet.padded = 1;
  sheet.one_origin = true;
  for (int k = 0; k < 3; ++k) {
    sheet.origin[k][0] = origin[k];
    sheet.direction[k][0] = direction[k];
  }
  sheet.length[0] = glm::length(direction);
  sheet.start_time[0] = clock.start;
  sheet.time_rate[0] = clock.rate;
}

}  // namespace

SurfaceSet::SurfaceSet() = default;
SurfaceSet::SurfaceSet(SurfaceSet&&) noexcept = default;
SurfaceSet& SurfaceSet::operator=(SurfaceSet&&) noexcept = default;
SurfaceSet::~SurfaceSet() = default;

const PlacedSurface& SurfaceSet::at(int surface) const {
  return surfaces_[static_cast<std::size_t>(surface)];
}

std::size_t SurfaceSet::size() const {
  return surfaces_.size();
}

const Shape& SurfaceSet::shape(int surface) const {
  return at(surface).shape;
}

bool SurfaceSet::casts_shadow(int surface) const {
  return at(surface).lanes.casts_shadow;
}

bool SurfaceSet::is_convex(int surface) const {
  return methods(shape(surface)).is_convex;
}

bool SurfaceSet::is_flat(int surface) const {
  return methods(shape(surface)).is_flat;
}

bool SurfaceSet::is_smooth(int surface) const {
  const Shape& its = shape(surface);
  if (!its.solid) return backlight::is_smooth(its);
  return std::ranges::any_of(
      its.solid->leaves(), [](const Solid::Leaf& leaf) { return backlight::is_smooth(leaf.surface.shape); });
}

bool SurfaceSet::moves(int surface) const {
  const Shape& its = shape(surface);
  if (its.motion) return true;
  return its.solid && std::ranges::any_of(its.solid->leaves(), [](const Solid::Leaf& leaf) {
           return leaf.surface.shape.motion != nullptr;
         });
}

bool SurfaceSet::any_moves() const {
  for (int i = 0; i < static_cast<int>(surfaces_.size()); ++i) {
    if (moves(i)) return true;
  }
  return false;
}

double SurfaceSet::opaque_radius(int surface) const {
  const LaneSurface& lanes = at(surface).lanes;
  return lanes.kind == ShapeKind::sphere && lanes.aligned && lanes.casts_shadow && !lanes.is_carried
             ? lanes.values[0]
             : 0.0;
}

void SurfaceSet::reserve(std::size_t count) {
  surfaces_.reserve(count);
}

int SurfaceSet::add(const Shape& shape, const Placement& placement, bool casts_shadow) {
  assert(problem(shape).empty() && problem(placement).empty());
  surfaces_.push_back(place(shape, placement));
  surfaces_.back().lanes.casts_shadow = casts_shadow;
  return static_cast<int>(surfaces_.size()) - 1;
}

BoundingSphere SurfaceSet::around(const std::vector<AxisBox>& boxes, const std::vector<int>& bounded) const {
  if (boxes.empty()) return {};
  AxisBox box;
  for (const AxisBox& its : boxes) box.include(its);
  BoundingSphere whole{0.5 * box.lo + 0.5 * box.hi, 0.0};
  for (const int i : bounded) {
    const double reach = glm::length(at(i).position() - whole.centre) + at(i).radius();
    whole.radius = std::max(whole.radius, reach * (1.0 + 1e-15));
  }
  return whole;
}

void SurfaceSet::build() {
  direct_.clear();
  nodes_.clear();
  std::vector<AxisBox> boxes;
  std::vector<int> bounded;
  for (int i = 0; i < static_cast<int>(surfaces_.size()); ++i) {
    (is_unbounded(at(i)) ? direct_ : bounded).push_back(i);
  }
  unbounded_ = direct_.size();
  boxes.reserve(bounded.size());
  for (const int i : bounded) boxes.push_back(axis_box(at(i)));
  bounds_of_bounded_ = around(boxes, bounded);
  if (bounded.size() == 1) direct_.push_back(bounded.front());
  if (bounded.size() < 2) return;
  nodes_ = wide_tree(boxes);
  for (WideNode& node : nodes_) {
    for (std::int32_t& child : node.child) {
      if (child < 0) child = ~bounded[static_cast<std::size_t>(~child)];
    }
  }
}

Hit SurfaceSet::nearest(const Vec3& origin, const Vec3& direction, double lambda_limit, const RayClock& clock,
                        Search search, Among among) const {
  Hit best;
  if (search == Search::every_surface) {
    best.lambda = lambda_limit;
    for (int i = 0; i < static_cast<int>(surfaces_.size()); ++i) {
      if (among == Among::bounded && is_unbounded(at(i))) continue;
      const Hit hit = first_crossing(at(i), i, {origin, direction, clock});
      if (hit.lambda < best.lambda) best = hit;
    }
    return best.found() ? best : Hit{};
  }
  RaySheet ray;
  put(ray, origin, direction, clock);
  SheetHits hits;
  hits.clear(1);
  hits.lambda[0] = lambda_limit;
  Walk<1>::nearest(walk_surfaces(among, 0.0), ray, 1, hits);
  if (hits.who[0] < 0.0) return {};
  return {hits.lambda[0], static_cast<int>(hits.who[0]), hits.part_of(0), hits.is_unresolved(0),
          hits.along[0]};
}

bool SurfaceSet::blocked(const Vec3& origin, const Vec3& direction, double lambda_max, const RayClock& clock,
                         Search search, Among among) const {
  if (search == Search::every_surface) {
    for (int i = 0; i < static_cast<int>(surfaces_.size()); ++i) {
      if (!casts_shadow(i) || (among == Among::bounded && is_unbounded(at(i)))) continue;
      if (is_blocked_by(at(i), {origin, direction, clock}, lambda_max)) return true;
    }
    return false;
  }
  RaySheet ray;
  put(ray, origin, direction, clock);
  return Walk<1>::blocked(walk_surfaces(among, 0.0), ray, 1, {lambda_max, nullptr}) != 0;
}

SurfacePoint SurfaceSet::resolve(const Hit& hit, const Vec3& origin, const Vec3& direction,
                                 const RayClock& clock) const {
  assert(hit.found());
  const PlacedSurface& surface = at(hit.surface);
  const LocalLine line = local_line(along_with(surface, {origin, direction, clock}), surface);
  if (!std::isnan(hit.along)) return surface_point(surface, line, {hit.along, hit.part, hit.unresolved});
  // A plane, whose λ has a formula of its own; at λ itself where it is all but parallel to the ray.
  const Crossings found = crossings(surface.shape, line, 0.0, Wanted::first);
  if (found.count > 0 && std::abs(line.lambda(found.list[0].t) - hit.lambda) < infinite) {
    return surface_point(surface, line, found.list[0]);
  }
  LocalLine there = line;
  const Vec3 offset = (origin - surface.position()) + hit.lambda * direction;
  there.point =
      vec3(surface.lanes.aligned ? one_lane(offset) : surface.lanes.local_from_rest.times(one_lane(offset)));
  return surface_point(surface, there, {0.0, hit.part, false});
}

Hit SurfaceSet::first_crossing_of(int surface, const Vec3& origin, const Vec3& direction,
                                  const RayClock& clock) const {
  return first_crossing(at(surface), surface, {origin, direction, clock});
}

BoundingSphere SurfaceSet::bounds(int surface) const {
  return {at(surface).position(), at(surface).radius()};
}

namespace {

BoundingSphere both(const BoundingSphere& a, const BoundingSphere& b) {
  if (a.radius < 0.0) return b;
  if (b.radius < 0.0) return a;
  const Vec3 way = b.centre - a.centre;
  const double apart = glm::length(way);
  if (apart + b.radius <= a.radius) return a;
  if (!(apart + a.radius > b.radius)) return b;
  const double radius = 0.5 * (apart + a.radius + b.radius);
  return {a.centre + (radius - a.radius) / apart * way, radius * (1.0 + 1e-14)};
}

/// About where a surface is met, as `of_path` (its motion, where its local coordinates begin) says of what
/// goes along a path; about its bounds where that says more.
template <class OfPath>
BoundingSphere met_sphere(const PlacedSurface& surface, const Vec3& from, const OfPath& of_path) {
  const Vec3 place = from + surface.position();
  const BoundingSphere always{place, surface.radius()};
  BoundingSphere met{place, infinite};
  if (const MatterMotion* motion = surface.shape.motion.get(); motion != nullptr && motion->ball()) {
    met = of_path(*motion, place);
    met.centre += place;
  } else if (surface.shape.solid && surface.lanes.aligned) {
    met = {};
    for (const Solid::Leaf& leaf : surface.shape.solid->leaves()) {
      met = both(met, met_sphere(leaf.surface, place, of_path));
    }
  }
  return met.radius < always.radius ? met : always;
}

bool travels(const PlacedSurface& surface) {
  const Shape& its = surface.shape;
  if (its.motion) return its.motion->ball().has_value();
  return its.solid && std::ranges::any_of(its.solid->leaves(),
                                          [](const Solid::Leaf& leaf) { return travels(leaf.surface); });
}

/// Whether this is all: one surface within a ball on a path.
bool is_one_ball(const std::vector<PlacedSurface>& surfaces) {
  const MatterMotion* motion = surfaces.size() == 1 ? surfaces[0].shape.motion.get() : nullptr;
  return motion != nullptr && motion->ball();
}

}  // namespace

bool SurfaceSet::any_travels() const {
  return std::ranges::any_of(surfaces_, travels);
}

BoundingSphere SurfaceSet::seen_from(const Vec3& place, double time) const {
  if (!any_moves()) return bounds();
  BoundingSphere all;
  for (const PlacedSurface& surface : surfaces_) {
    all = both(all, met_sphere(surface, Vec3{0.0}, [&](const MatterMotion& motion, const Vec3& origin) {
                 return backlight::seen_from(motion, place - origin, time);
               }));
  }
  return all;
}

BoundingSphere SurfaceSet::lit_from(const LightFlash& flash) const {
  BoundingSphere all;
  for (const PlacedSurface& surface : surfaces_) {
    all = both(all, met_sphere(surface, Vec3{0.0}, [&](const MatterMotion& motion, const Vec3& origin) {
                 LightFlash its = flash;
                 its.place -= origin;
                 return backlight::lit_from(motion, its);
               }));
  }
  return all;
}

PassingBall SurfaceSet::passing_seen_from(const Vec3& place, double time) const {
  if (!is_one_ball(surfaces_)) return {};
  const Vec3 about = at(0).position();
  return ball_of(backlight::passing_seen_from(*shape(0).motion, place - about, time), about);
}

void SurfaceSet::lit_from(std::span<const SurfaceSet* const> sets, std::span<const LightFlash> flashes,
                          std::span<BoundingSphere> spheres, std::span<PassingBall> balls) {
  std::array<std::size_t, most_lit> whose;
  std::array<const MatterMotion*, most_lit> motions;
  std::array<LightFlash, most_lit> local;
  std::array<Passing, most_lit> passings;
  std::size_t count = 0;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (!is_one_ball(sets[i]->surfaces_)) {
      spheres[i] = sets[i]->lit_from(flashes[i]);
      balls[i] = {};
      continue;
    }
    whose[count] = i;
    motions[count] = sets[i]->shape(0).motion.get();
    local[count] = flashes[i];
    local[count++].place -= sets[i]->at(0).position();
  }
  passings_lit_from({motions.data(), count}, {local.data(), count}, {passings.data(), count});
  for (std::size_t k = 0; k < count; ++k) {
    const PlacedSurface& surface = sets[whose[k]]->at(0);
    balls[whose[k]] = ball_of(passings[k], surface.position());
    spheres[whose[k]] = met_sphere(surface, Vec3{0.0}, [&](const MatterMotion&, const Vec3&) {
      return sphere_of(passings[k], local[k]);
    });
  }
}

BoundingSphere SurfaceSet::bounds() const {
  if (unbounded_ > 0) return bounds(direct_.front());
  return surfaces_.size() == 1 ? bounds(0) : bounds_of_bounded_;
}

}  // namespace backlight
