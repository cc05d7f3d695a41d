// The questions of many rays at once, of SurfaceSet.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "backlight/surface/matter_motion.h"
#include "backlight/surface/surface_set.h"
#include "moving_ball.h"
#include "presence.h"
#include "shape_table.h"
#include "surface_kernels.h"
#include "surface_point.h"

namespace backlight {
namespace {

/// Some of the rays brought next to a surface; `ray_of`: which they are.
struct Near {
  LocalLines lines;
  int ray_of[sheet_size];

  Near(const PlacedSurface& surface, const RaySheet& sheet, std::uint64_t rays) {
    if ((rays & (rays + 1)) == 0) {
      take_first(sheet, static_cast<std::size_t>(std::popcount(rays)));
    } else {
      for (; rays != 0; rays &= rays - 1) add(sheet, __builtin_ctzll(rays));
      for (std::size_t i = lines.count; i < lines.padded(); ++i) put(sheet, ray_of[lines.count - 1], i);
    }
    surface_kernels(sheet.instructions).local_lines(surface.lanes, lines);
  }

 private:
  // As add() would of each: whole rows.
  void take_first(const RaySheet& sheet, std::size_t count) {
    lines.count = count;
    std::iota(ray_of, ray_of + count, 0);
    const std::size_t padded = lines.padded();
    const auto take = [&](const double* from, double* to, bool same) {
      if (same) return std::fill_n(to, padded, *from);
      std::fill(std::copy_n(from, count, to), to + padded, from[count - 1]);
      return to + padded;
    };
    for (int k = 0; k < 3; ++k) {
      take(sheet.origin[k], lines.origin[k], sheet.one_origin);
      take(sheet.direction[k], lines.along[k], false);
    }
    take(sheet.start_time, lines.time, sheet.one_origin);
    take(sheet.time_rate, lines.rate, false);
  }
  void add(const RaySheet& sheet, int ray) {
    put(sheet, ray, lines.count);
    ray_of[lines.count++] = ray;
  }
  void put(const RaySheet& sheet, int ray, std::size_t i) {
    const int from = sheet.one_origin ? 0 : ray;
    for (int k = 0; k < 3; ++k) {
      lines.origin[k][i] = sheet.origin[k][from];
      lines.along[k][i] = sheet.direction[k][ray];
    }
    lines.time[i] = sheet.start_time[from];
    lines.rate[i] = sheet.time_rate[ray];
  }
};

bool nearest_of(const void* set, int index, std::uint64_t rays, const RaySheet& sheet, double who,
                SheetHits& hits) {
  const PlacedSurface& surface = static_cast<const PlacedSurface*>(set)[index];
  const Near near(surface, sheet, rays);
  FirstOnLine found[LocalLines::most];
  if (surface.shape.presence) {
    for (std::size_t i = 0; i < near.lines.count; ++i) {
      const Hit hit = first_present(surface, index, near.lines.line(i));
      if (hit.found()) found[i] = {hit.along, hit.unresolved, hit.part};
    }
  } else {
    methods(surface.shape).first_crossings(surface.shape, near.lines, 0.0, {found, near.lines.count});
  }
  bool any = false;
  for (std::size_t i = 0; i < near.lines.count; ++i) {
    const double lambda = near.lines.lambda(i, found[i].t);
    const int ray = near.ray_of[i];
    const bool first = lambda < hits.lambda[ray] || (lambda == hits.lambda[ray] && who < hits.who[ray]);
    if (!(lambda > 0.0) || !first) continue;
    hits.lambda[ray] = lambda;
    hits.who[ray] = who;
    hits.along[ray] = found[i].t;
    hits.part[ray] = found[i].unresolved ? -1.0 - found[i].part : found[i].part;
    any = true;
  }
  return any;
}

std::uint64_t blocked_by(const void* set, int index, std::uint64_t rays, const RaySheet& sheet,
                         double lambda_max) {
  const PlacedSurface& surface = static_cast<const PlacedSurface*>(set)[index];
  const Near near(surface, sheet, rays);
  bool blocked[LocalLines::most];
  if (surface.shape.presence) {
    for (std::size_t i = 0; i < near.lines.count; ++i) {
      blocked[i] = first_present(surface, index, near.lines.line(i)).lambda < lambda_max;
    }
  } else
    methods(surface.shape).blocks(surface.shape, near.lines, 0.0, lambda_max, {blocked, near.lines.count});
  std::uint64_t all = 0;
  for (std::size_t i = 0; i < near.lines.count; ++i) {
    if (blocked[i]) all |= std::uint64_t{1} << near.ray_of[i];
  }
  return all;
}

/// Where the rays are at λ: about one of them.
LightFlash flash_of(const RaySheet& sheet, std::uint64_t rays, double lambda) {
  LightFlash flash;
  bool any = false;
  for (; rays != 0; rays &= rays - 1) {
    const int ray = __builtin_ctzll(rays), from = sheet.one_origin ? 0 : ray;
    const double time = sheet.start_time[from] + lambda * sheet.time_rate[ray];
    Vec3 place{0.0};
    for (int k = 0; k < 3; ++k) place[k] = sheet.origin[k][from] + lambda * sheet.direction[k][ray];
    if (!any) {
      flash.place = place;
      flash.time = time;
      any = true;
    }
    flash.apart = std::max(flash.apart, glm::length(place - flash.place) + std::abs(time - flash.time));
    if (lambda == 0.0) break;
  }
  return flash;
}

PassingBall find_passing(const void* set, int index, std::uint64_t rays, const RaySheet& sheet,
                         double lambda) {
  const PlacedSurface& surface = static_cast<const PlacedSurface*>(set)[index];
  LightFlash flash = flash_of(sheet, rays, lambda);
  flash.place -= surface.position();
  const MatterMotion& motion = *surface.shape.motion;
  return ball_of(
      lambda == 0.0 ? passing_seen_from(motion, flash.place, flash.time) : passing_lit_from(motion, flash),
      surface.position());
}

void put(const SurfacePoint& point, int ray, SheetPoints& out) {
  for (int k = 0; k < 3; ++k) {
    out.position[k][ray] = point.position[k];
    out.normal[k][ray] = point.normal[k];
    out.shading_normal[k][ray] = point.shading_normal[k];
  }
  out.error_bound[ray] = point.error_bound;
  out.u[ray] = point.u;
  out.v[ray] = point.v;
  out.member[ray] = point.member;
  for (int k = 0; k < 3; ++k) out.velocity[k][ray] = point.velocity[k];
  out.own_time[ray] = point.own_time;
}

/// Of a shape without a closed form.
void points_by_lines(const PlacedSurface& surface, const Near& near, const SheetHits& hits, bool textured,
                     SheetPoints& out) {
  Crossing crossings[LocalLines::most];
  LocalPoint local[LocalLines::most];
  const std::size_t count = near.lines.count;
  for (std::size_t i = 0; i < count; ++i) {
    const int ray = near.ray_of[i];
    crossings[i] = {hits.along[ray], hits.part_of(ray), hits.is_unresolved(ray)};
  }
  const auto wanted = textured ? TextureCoordinates::wanted : TextureCoordinates::unwanted;
  methods(surface.shape).points(surface.shape, near.lines, {crossings, count}, wanted, {local, count});
  double times[LocalLines::most];
  SurfacePoint found[LocalLines::most];
  for (std::size_t i = 0; i < count; ++i)
    times[i] = near.lines.clock_start[i] + crossings[i].t * near.lines.clock_rate[i];
  surface_points(surface, {local, count}, {times, count}, {found, count});
  for (std::size_t i = 0; i < count; ++i) put(found[i], near.ray_of[i], out);
}

/// Of matter that moves along its own surface: what its motion says of the points that lanes have found, told
/// in local coordinates.
void add_motion_to(const PlacedSurface& surface, const Near& near, const SheetHits& hits,
                   const double (&local)[3][sheet_size], SheetPoints& out) {
  LocalPoint points[LocalLines::most];
  double times[LocalLines::most];
  const std::size_t count = near.lines.count;
  for (std::size_t i = 0; i < count; ++i) {
    const int ray = near.ray_of[i];
    points[i].position = {local[0][ray], local[1][ray], local[2][ray]};
    times[i] = near.lines.clock_start[i] + hits.along[ray] * near.lines.clock_rate[i];
  }
  add_motion(surface, {points, count}, {times, count});
  for (std::size_t i = 0; i < count; ++i) {
    const int ray = near.ray_of[i];
    const Vec3 velocity = vec3(surface.lanes.rest_from_local.times(one_lane(points[i].velocity)));
    for (int k = 0; k < 3; ++k) out.velocity[k][ray] = velocity[k];
    out.own_time[ray] = points[i].own_time;
    out.u[ray] = points[i].u;
    out.v[ray] = points[i].v;
  }
}

/// Whether the points of a travelling ball are not all that is asked of it.
bool tells_more_than_points(const Shape& shape, bool textured) {
  return travelling_ball_turns(shape) || shape.motion->counts_time() || textured;
}

}  // namespace

WalkSurfaces SurfaceSet::walk_surfaces(Among among, double first_number, const PassingBall& passing) const {
  const std::size_t skipped = among == Among::bounded ? unbounded_ : 0;
  return {.nodes = nodes_.empty() ? nullptr : nodes_.data(),
          .surfaces = surfaces_.data(),
          .direct = direct_.data() + skipped,
          .direct_count = static_cast<int>(direct_.size() - skipped),
          .is_lone = surfaces_.size() == 1,
          .first_who = first_number,
          .set = surfaces_.data(),
          .nearest_of = nearest_of,
          .blocked_by = blocked_by,
          .known_passing = passing,
          .passing = find_passing};
}

void SurfaceSet::nearest(const RaySheet& sheet, std::uint64_t rays, double first_number, SheetHits& hits,
                         const PassingBall& passing) const {
  surface_kernels(sheet.instructions)
      .nearest(walk_surfaces(Among::all, first_number, passing), sheet, rays, hits);
}

std::uint64_t SurfaceSet::blocked(const RaySheet& sheet, std::uint64_t rays, double lambda_max,
                                  double first_number, const double (*own)[sheet_size],
                                  const PassingBall& passing) const {
  return surface_kernels(sheet.instructions)
      .blocked(walk_surfaces(Among::all, first_number, passing), sheet, rays,
               {lambda_max, own == nullptr ? nullptr : *own});
}

void SurfaceSet::points(const RaySheet& given, int surface, int first, int last, const SheetHits& hits,
                        bool with_texture_coordinates, SheetPoints& points) const {
  const PlacedSurface& placed = at(surface);
  RaySheet along;
  if (placed.lanes.is_carried) go_along<Lanes<2>>(placed.lanes, given, along);
  const RaySheet& sheet = placed.lanes.is_carried ? along : given;
  const std::uint64_t all = (last < 64 ? std::uint64_t{1} << last : 0) - (std::uint64_t{1} << first);
  const ShapeMethods& has = methods(placed.shape);
  if (has.sheet_points != nullptr && placed.shape.motion == nullptr) {
    const auto wanted = with_texture_coordinates ? TextureCoordinates::wanted : TextureCoordinates::unwanted;
    has.sheet_points(placed, sheet, first, last, hits, wanted, points);
    return;
  }
  const auto texture = has.texture;
  if (texture == nullptr) {
    points_by_lines(placed, Near(placed, sheet, all), hits, with_texture_coordinates, points);
    return;
  }
  const bool travels = placed.shape.kind == ShapeKind::travelling_ball;
  const bool turns = placed.shape.motion && !placed.lanes.is_carried && !travels;
  const bool singly = placed.shape.presence != nullptr ||
                      (travels && tells_more_than_points(placed.shape, with_texture_coordinates));
  double local[3][sheet_size];
  std::uint64_t left = singly ? all
                              : surface_kernels(sheet.instructions)
                                    .points(placed.lanes, sheet, first, last, hits, points,
                                            with_texture_coordinates || turns ? local : nullptr);
  if (turns && !singly) add_motion_to(placed, Near(placed, sheet, all), hits, local, points);
  for (int i = first; i < last && with_texture_coordinates && !singly && !turns; ++i) {
    LocalPoint point{.position = {local[0][i], local[1][i], local[2][i]}};
    texture(placed.shape, hits.part_of(i), point);
    points.u[i] = point.u;
    points.v[i] = point.v;
  }
  for (; left != 0; left &= left - 1) {
    const int i = __builtin_ctzll(left);
    const int from = given.one_origin ? 0 : i;
    const Vec3 origin{given.origin[0][from], given.origin[1][from], given.origin[2][from]};
    const Vec3 direction{given.direction[0][i], given.direction[1][i], given.direction[2][i]};
    const RayClock clock{given.start_time[from], given.time_rate[i]};
    const Hit hit = singly
                        ? Hit{hits.lambda[i], surface, hits.part_of(i), hits.is_unresolved(i), hits.along[i]}
                        : Hit{hits.lambda[i], surface};
    put(resolve(hit, origin, direction, clock), i, points);
  }
}

}  // namespace backlight
