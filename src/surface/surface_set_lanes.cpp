// The questions of many rays at once, of SurfaceSet.
#include <algorithm>
#include <cmath>

#include "backlight/surface/surface_set.h"
#include "placed_surface.h"
#include "shape_table.h"
#include "surface_kernels.h"
#include "surface_point.h"

namespace backlight {
namespace {

/// The rays from `first` on, as many as there is room for, brought next to a surface.
const LocalLines& lines_of(const PlacedSurface& surface, const SurfaceSet::Rays& rays, std::size_t first) {
  thread_local LocalLines lines;
  lines.count = std::min(LocalLines::most, rays.count - first);
  const auto copy = [&](const double* from, double* to) {
    std::copy_n(from + first, lines.count, to);
    std::fill(to + lines.count, to + lines.padded(), to[lines.count - 1]);
  };
  for (int axis = 0; axis < 3; ++axis) {
    copy(rays.origin[axis], lines.origin[axis]);
    copy(rays.direction[axis], lines.along[axis]);
  }
  copy(rays.time, lines.time);
  copy(rays.rate, lines.rate);
  surface_kernels().local_lines(lane_placement(surface), lines);
  return lines;
}

RestRay ray_of(const SurfaceSet::Rays& rays, std::size_t i) {
  return {{rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]},
          {rays.direction[0][i], rays.direction[1][i], rays.direction[2][i]},
          {rays.time[i], rays.rate[i]}};
}

}  // namespace

void SurfaceSet::first_crossings_of(int surface, const Rays& rays, std::span<Hit> hits) const {
  const PlacedSurface& placed = surfaces_[static_cast<std::size_t>(surface)];
  const auto many = methods(placed.shape).first_crossings;
  if (many == nullptr) {
    for (std::size_t i = 0; i < rays.count; ++i) {
      const RestRay ray = ray_of(rays, i);
      hits[i] = first_crossing_of(surface, ray.origin, ray.direction, ray.clock);
    }
    return;
  }
  FirstOnLine found[LocalLines::most];
  for (std::size_t first = 0; first < rays.count; first += LocalLines::most) {
    const LocalLines& lines = lines_of(placed, rays, first);
    many(placed.shape, lines, 0.0, {found, lines.count});
    for (std::size_t i = 0; i < lines.count; ++i) {
      const FirstOnLine& its = found[i];
      const double lambda = lines.lambda(i, its.t);
      const bool hit = lambda > 0.0 && lambda < infinite;
      hits[first + i] = hit ? Hit{lambda, surface, its.part, its.unresolved, its.t} : Hit{};
    }
  }
}

void SurfaceSet::blocked_by(int surface, const Rays& rays, double lambda_max, std::span<bool> blocked) const {
  const PlacedSurface& placed = surfaces_[static_cast<std::size_t>(surface)];
  const auto many = methods(placed.shape).blocks;
  if (many == nullptr) {
    for (std::size_t i = 0; i < rays.count; ++i) {
      blocked[i] = is_blocked_by(placed, ray_of(rays, i), 0.0, lambda_max);
    }
    return;
  }
  for (std::size_t first = 0; first < rays.count; first += LocalLines::most) {
    many(placed.shape, lines_of(placed, rays, first), 0.0, lambda_max, blocked.subspan(first));
  }
}

void SurfaceSet::resolve_all(std::span<const Hit> hits, const Rays& rays, bool with_texture_coordinates,
                             std::span<SurfacePoint> points) const {
  const PlacedSurface& surface = surfaces_[static_cast<std::size_t>(hits[0].surface)];
  const auto many = methods(surface.shape).points;
  const auto lost = [](const Hit& hit) { return std::isnan(hit.along); };
  if (many == nullptr || std::any_of(hits.begin(), hits.end(), lost)) {
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const RestRay one = ray_of(rays, i);
      points[i] = resolve(hits[i], one.origin, one.direction, one.clock);
    }
    return;
  }
  const auto wanted = with_texture_coordinates ? TextureCoordinates::wanted : TextureCoordinates::unwanted;
  Crossing crossings[LocalLines::most];
  LocalPoint local[LocalLines::most];
  for (std::size_t first = 0; first < rays.count; first += LocalLines::most) {
    const LocalLines& lines = lines_of(surface, rays, first);
    for (std::size_t i = 0; i < lines.count; ++i) {
      const Hit& hit = hits[first + i];
      crossings[i] = {hit.along, hit.part, hit.unresolved};
    }
    many(surface.shape, lines, {crossings, lines.count}, wanted, {local, lines.count});
    for (std::size_t i = 0; i < lines.count; ++i) points[first + i] = surface_point(surface, local[i]);
  }
}

LaneSurface SurfaceSet::lane_surface(int surface) const {
  const PlacedSurface& placed = surfaces_[static_cast<std::size_t>(surface)];
  const Mat3& inverse = placed.placement.local_from_rest();
  LaneSurface lanes{lane_placement(placed)};
  if (placed.shape.kind == ShapeKind::sphere) lanes.kind = LaneSurface::Kind::sphere;
  if (placed.shape.kind == ShapeKind::plane) lanes.kind = LaneSurface::Kind::plane;
  lanes.radius = placed.shape.values[0];
  lanes.bounding_radius = placed.radius;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      lanes.normal_from_gradient.column[c][r] = inverse[r][c];
      lanes.rest_from_local.column[c][r] = placed.placement.rest_from_local()[c][r];
    }
  }
  return lanes;
}

}  // namespace backlight
