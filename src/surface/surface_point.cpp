#include "surface_point.h"

#include "backlight/surface/matter_motion.h"
#include "lane_path.h"

namespace backlight {

SurfacePoint surface_point(const PlacedSurface& surface, const LocalLine& line, const Crossing& crossing) {
  return surface_point(surface, methods(surface.shape).point(surface.shape, line, crossing),
                       line.clock.start + crossing.t * line.clock.rate);
}

void add_motion(const PlacedSurface& surface, std::span<LocalPoint> points, std::span<const double> times) {
  constexpr std::size_t window = LocalLines::most;
  const MatterMotion& motion = *surface.shape.motion;
  const LaneMatrix& rest_from_local = surface.lanes.rest_from_local;
  Mat3 matrix(1.0);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) matrix[c][r] = rest_from_local.column[c][r];
  Vec3 places[window];
  MatterMotion::Matter found[window];
  for (std::size_t i = 0; i < points.size(); ++i) places[i] = points[i].position;
  motion.matter({places, points.size()}, times, {found, points.size()});
  for (std::size_t i = 0; i < points.size(); ++i) {
    LocalPoint& point = points[i];
    if (!point.moves) point.velocity = found[i].velocity;
    point.moves = true;
    if (motion.counts_time()) point.own_time = motion.own_time(point.position, times[i], matrix);
    if (const Shape* body = motion.body_shape(); body != nullptr) {
      LocalPoint of_body{.position = found[i].body_point};
      texture_of_body(*body, of_body);
      point.u = of_body.u;
      point.v = of_body.v;
    }
  }
}

SurfacePoint placed_point(const PlacedSurface& surface, const LocalPoint& point) {
  const LanePoint<Lanes<1>> placed = in_rest_frame<Lanes<1>>(
      surface.lanes, {one_lane(point.position), one_lane(point.gradient), point.error}, point.is_unit);
  Vec3 shading = vec3(placed.normal);
  if (point.shading != Vec3{0.0}) {
    const LaneVec3<Lanes<1>> by_rest =
        surface.lanes.local_from_rest.transposed_times(one_lane(point.shading));
    shading = vec3((Lanes<1>(1.0) / length(by_rest)) * by_rest);
  }
  return {.position = vec3(placed.position),
          .normal = vec3(placed.normal),
          .shading_normal = shading,
          .u = point.u,
          .v = point.v,
          .member = point.member,
          .error_bound = placed.error_bound.v,
          .moves = point.moves,
          .velocity =
              point.moves ? vec3(surface.lanes.rest_from_local.times(one_lane(point.velocity))) : Vec3{0.0},
          .own_time = point.own_time};
}

namespace {

/// In the frame, of what is carried straight on and found in its own coordinates.
SurfacePoint carried_point(const PlacedSurface& surface, const LocalPoint& point, double time) {
  SurfacePoint placed = placed_point(surface, point);
  const CarriedPlace<Lanes<1>> place =
      carried<Lanes<1>>(surface.lanes, {one_lane(placed.position), {}, placed.error_bound}, time);
  placed.position = vec3(place.position);
  placed.error_bound = place.error_bound.v;
  placed.moves = true;
  placed.velocity = *surface.shape.motion->carriage();
  placed.own_time = place.own_time.v;
  return placed;
}

}  // namespace

SurfacePoint surface_point(const PlacedSurface& surface, const LocalPoint& point, double time) {
  LocalPoint with_motion = point;
  SurfacePoint found;
  surface_points(surface, {&with_motion, 1}, {&time, 1}, {&found, 1});
  return found;
}

void surface_points(const PlacedSurface& surface, std::span<LocalPoint> points, std::span<const double> times,
                    std::span<SurfacePoint> found) {
  const bool is_carried = surface.lanes.is_carried;
  if (surface.shape.motion && !is_carried) add_motion(surface, points, times);
  for (std::size_t i = 0; i < points.size(); ++i) {
    found[i] = is_carried ? carried_point(surface, points[i], times[i]) : placed_point(surface, points[i]);
    if (!found[i].moves) found[i].own_time = times[i];
  }
}

}  // namespace backlight
