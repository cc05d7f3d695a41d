#include "backlight/surface/surface_set.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "bounding_tree.h"
#include "local_line.h"
#include "placed_surface.h"
#include "shape_table.h"
#include "surface_point.h"

namespace backlight {
namespace {

/// With more bounded surfaces than this, walking a tree of boxes beats trying their spheres one after the
/// other.
constexpr std::size_t list_limit = 8;

/// Room for the rounding of sums of a few terms, relative to the largest of them.
constexpr double rounding_room = 2e-15;

/// λ and face of the first crossing beyond lambda_min; infinity if there is none.
struct FirstCrossing {
  double lambda = std::numeric_limits<double>::infinity();
  int part = 0;
  bool unresolved = false;
  double along = std::numeric_limits<double>::quiet_NaN();
};

/// Where the ray meets the plane (maybe at λ < 0), or infinity. Only the height above the plane counts: the
/// way to the plane's origin, which may be far, would add its rounding.
double plane_lambda(const Placement& placement, const RestRay& ray) {
  const Mat3& local_from_rest = placement.local_from_rest();
  const Vec3 up{local_from_rest[0].y, local_from_rest[1].y, local_from_rest[2].y};
  const Vec3 descent = up * ray.direction;
  const double rate = descent.x + descent.y + descent.z;
  // A ray along a tilted plane has a rate of rounding noise, which is no crossing.
  const double noise = rounding_room * (std::abs(descent.x) + std::abs(descent.y) + std::abs(descent.z));
  if (!(std::abs(rate) > noise)) {
    return std::numeric_limits<double>::infinity();
  }
  return -glm::dot(up, ray.origin - placement.position()) / rate;
}

FirstCrossing first_of(const Crossings& found, const LocalLine& line, double lambda_min) {
  for (int i = 0; i < found.count; ++i) {
    const double lambda = line.lambda(found.list[i].t);
    if (lambda > lambda_min) {
      return {lambda, found.list[i].part, found.list[i].unresolved, found.list[i].t};
    }
  }
  return {};
}

FirstCrossing first_crossing(const PlacedSurface& surface, const RestRay& ray, double lambda_min) {
  if (surface.shape.kind == ShapeKind::plane) {
    const double lambda = plane_lambda(surface.placement, ray);
    return lambda > lambda_min ? FirstCrossing{lambda, 0, false} : FirstCrossing{};
  }
  const LocalLine line = local_line(ray, surface);
  return first_of(crossings(surface.shape, line, lambda_min, Wanted::first), line, lambda_min);
}

}  // namespace

SurfaceSet::SurfaceSet() = default;
SurfaceSet::SurfaceSet(SurfaceSet&&) noexcept = default;
SurfaceSet& SurfaceSet::operator=(SurfaceSet&&) noexcept = default;
SurfaceSet::~SurfaceSet() = default;

std::size_t SurfaceSet::size() const {
  return surfaces_.size();
}

const Shape& SurfaceSet::shape(int surface) const {
  return surfaces_[static_cast<std::size_t>(surface)].shape;
}

bool SurfaceSet::casts_shadow(int surface) const {
  return surfaces_[static_cast<std::size_t>(surface)].casts_shadow;
}

int SurfaceSet::add(const Shape& shape, const Placement& placement, bool casts_shadow) {
  assert(problem(shape).empty() && problem(placement).empty());
  surfaces_.push_back(place(shape, placement));
  surfaces_.back().casts_shadow = casts_shadow;
  return static_cast<int>(surfaces_.size()) - 1;
}

void SurfaceSet::build(SearchMethod method) {
  infinite_.clear();
  std::vector<int> bounded;
  for (int i = 0; i < static_cast<int>(surfaces_.size()); ++i) {
    (is_infinite(surfaces_[static_cast<std::size_t>(i)].shape) ? infinite_ : bounded).push_back(i);
  }
  tree_.reset();
  index_ = bounded;
  const bool many = bounded.size() > list_limit;
  if (!bounded.empty() && (method == SearchMethod::tree || (method == SearchMethod::automatic && many))) {
    std::vector<AxisBox> boxes;
    boxes.reserve(bounded.size());
    for (const int i : bounded) {
      boxes.push_back(axis_box(surfaces_[static_cast<std::size_t>(i)]));
    }
    tree_ = std::make_unique<BoundingTree>(boxes);
    std::transform(tree_->order().begin(), tree_->order().end(), index_.begin(),
                   [&](int k) { return bounded[static_cast<std::size_t>(k)]; });
  }
  for (auto* array : {&centre_x_, &centre_y_, &centre_z_, &radius_}) {
    array->clear();
  }
  for (const int i : index_) {
    const PlacedSurface& surface = surfaces_[static_cast<std::size_t>(i)];
    centre_x_.push_back(surface.placement.position().x);
    centre_y_.push_back(surface.placement.position().y);
    centre_z_.push_back(surface.placement.position().z);
    radius_.push_back(surface.radius);
  }
}

/// Whether the ray can meet the bounding sphere of a search slot between the two λ. Rounding never makes it
/// say no where the answer is yes.
bool SurfaceSet::may_meet(const RestRay& ray, double lambda_min, double lambda_max, std::size_t slot) const {
  const double x = ray.origin.x - centre_x_[slot];
  const double y = ray.origin.y - centre_y_[slot];
  const double z = ray.origin.z - centre_z_[slot];
  const Vec3& n = ray.direction;
  const double middle = -(x * n.x + y * n.y + z * n.z) * ray.inverse_square;
  const double px = x + middle * n.x;
  const double py = y + middle * n.y;
  const double pz = z + middle * n.z;
  const double radius = radius_[slot] + rounding_room * (std::abs(x) + std::abs(y) + std::abs(z));
  const double half = radius * ray.inverse_length;
  // & and not &&: three cheap tests without branches between them.
  return (px * px + py * py + pz * pz <= radius * radius) & (middle + half > lambda_min) &
         (middle - half <= lambda_max);
}

bool SurfaceSet::is_blocked_by(const PlacedSurface& surface, const RestRay& ray, double lambda_min,
                               double lambda_max) {
  const auto blocks = methods(surface.shape).blocks;
  if (blocks == nullptr) return first_crossing(surface, ray, lambda_min).lambda < lambda_max;
  LocalLines line;
  line.add(local_line(ray, surface));
  bool result = false;
  blocks(surface.shape, line, lambda_min, lambda_max, {&result, 1});
  return result;
}

/// Tries the surfaces of a range of the search order. True: the search may stop.
template <bool any>
bool SurfaceSet::search_range(const RestRay& ray, double lambda_min, std::size_t first, std::size_t last,
                              Hit& best) const {
  for (std::size_t slot = first; slot < last; ++slot) {
    if (!may_meet(ray, lambda_min, best.lambda, slot)) {
      continue;
    }
    const int index = index_[slot];
    const PlacedSurface& surface = surfaces_[static_cast<std::size_t>(index)];
    if constexpr (any) {
      if (!surface.casts_shadow || !is_blocked_by(surface, ray, lambda_min, best.lambda)) continue;
      best.surface = index;
      return true;
    } else {
      const FirstCrossing crossing = first_crossing(surface, ray, lambda_min);
      if (crossing.lambda < best.lambda || (crossing.lambda == best.lambda && index < best.surface)) {
        best = {crossing.lambda, index, crossing.part, crossing.unresolved, crossing.along};
      }
    }
  }
  return false;
}

template <bool any>
void SurfaceSet::search_tree(const RestRay& ray, double lambda_min, Hit& best) const {
  tree_->walk(
      ray, [&] { return best.lambda; },
      [&](std::size_t first, std::size_t last) {
        return search_range<any>(ray, lambda_min, first, last, best);
      });
}

template <bool any>
Hit SurfaceSet::search(const RestRay& ray, double lambda_min, double lambda_max,
                       const std::vector<int>& unbounded) const {
  Hit best;
  best.lambda = lambda_max;
  for (const int index : unbounded) {
    const PlacedSurface& surface = surfaces_[static_cast<std::size_t>(index)];
    if (any && !surface.casts_shadow) continue;
    const FirstCrossing crossing = first_crossing(surface, ray, lambda_min);
    if (crossing.lambda < best.lambda) {
      best = {crossing.lambda, index, crossing.part, crossing.unresolved, crossing.along};
      if constexpr (any) {
        return best;
      }
    }
  }
  if (tree_) {
    search_tree<any>(ray, lambda_min, best);
  } else {
    search_range<any>(ray, lambda_min, 0, index_.size(), best);
  }
  return best;
}

Hit SurfaceSet::nearest(const Vec3& origin, const Vec3& direction, double lambda_limit,
                        const RayClock& clock) const {
  const Hit hit = search<false>(RestRay(origin, direction, clock), 0.0, lambda_limit, infinite_);
  return hit.found() ? hit : Hit{};
}

Hit SurfaceSet::nearest_bounded(const Vec3& origin, const Vec3& direction, double lambda_limit,
                                const RayClock& clock) const {
  const Hit hit = search<false>(RestRay(origin, direction, clock), 0.0, lambda_limit, {});
  return hit.found() ? hit : Hit{};
}

bool SurfaceSet::blocked(const Vec3& origin, const Vec3& direction, double lambda_min, double lambda_max,
                         const RayClock& clock) const {
  return search<true>(RestRay(origin, direction, clock), lambda_min, lambda_max, infinite_).found();
}

bool SurfaceSet::blocked_bounded(const Vec3& origin, const Vec3& direction, double lambda_min,
                                 double lambda_max, const RayClock& clock) const {
  return search<true>(RestRay(origin, direction, clock), lambda_min, lambda_max, {}).found();
}

SurfacePoint SurfaceSet::resolve(const Hit& hit, const Vec3& origin, const Vec3& direction,
                                 const RayClock& clock) const {
  assert(hit.found());
  const PlacedSurface& surface = surfaces_[static_cast<std::size_t>(hit.surface)];
  const LocalLine line = local_line(RestRay(origin, direction, clock), surface);
  if (!std::isnan(hit.along)) return surface_point(surface, line, {hit.along, hit.part, hit.unresolved});
  const Crossings found = crossings(surface.shape, line, 0.0, Wanted::first);
  // λ is recomputed as it was, so the hit is found again exactly; a plane's λ has a formula of its own.
  const Crossing* nearest = nullptr;
  double off = std::numeric_limits<double>::infinity();
  for (int i = 0; i < found.count; ++i) {
    const double difference = std::abs(line.lambda(found.list[i].t) - hit.lambda);
    if (difference < off) {
      off = difference;
      nearest = &found.list[i];
    }
  }
  if (nearest == nullptr) {  // a plane all but parallel to the ray
    const Vec3 offset = (origin - surface.placement.position()) + hit.lambda * direction;
    LocalLine there = line;
    there.point = surface.to_local(offset);
    return surface_point(surface, there, {0.0, hit.part, false});
  }
  return surface_point(surface, line, *nearest);
}

Hit SurfaceSet::first_crossing_of(int surface, const Vec3& origin, const Vec3& direction,
                                  const RayClock& clock) const {
  const FirstCrossing first =
      first_crossing(surfaces_[static_cast<std::size_t>(surface)], RestRay(origin, direction, clock), 0.0);
  if (first.lambda == std::numeric_limits<double>::infinity()) return {};
  return {first.lambda, surface, first.part, first.unresolved, first.along};
}

std::size_t SurfaceSet::asked_one_by_one() const {
  return static_cast<std::size_t>(
      std::count_if(surfaces_.begin(), surfaces_.end(), [](const PlacedSurface& surface) {
        return surface.shape.kind != ShapeKind::sphere && !is_infinite(surface.shape) &&
               methods(surface.shape).first_crossings == nullptr;
      }));
}

BoundingSphere SurfaceSet::bounds(int surface) const {
  const PlacedSurface& placed = surfaces_[static_cast<std::size_t>(surface)];
  return {placed.placement.position(), placed.radius};
}

BoundingSphere SurfaceSet::bounds() const {
  for (const PlacedSurface& surface : surfaces_) {
    if (is_infinite(surface.shape)) return {surface.placement.position(), surface.radius};
  }
  return bounds_of_bounded();
}

BoundingSphere SurfaceSet::bounds_of_bounded() const {
  AxisBox box;
  bool any = false;
  for (const PlacedSurface& surface : surfaces_) {
    if (is_infinite(surface.shape)) continue;
    box.include(axis_box(surface));
    any = true;
  }
  if (!any) return {};
  BoundingSphere whole{0.5 * box.lo + 0.5 * box.hi, 0.0};
  for (const PlacedSurface& surface : surfaces_) {
    if (is_infinite(surface.shape)) continue;
    const double reach = glm::length(surface.placement.position() - whole.centre) + surface.radius;
    whole.radius = std::max(whole.radius, reach * (1.0 + 1e-15));
  }
  return whole;
}

}  // namespace backlight
