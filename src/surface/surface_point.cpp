#include "surface_point.h"

#include "backlight/surface/matter_motion.h"
#include "lane_path.h"

namespace backlight {

SurfacePoint surface_point(const PlacedSurface& surface, const LocalLine& line, const Crossing& crossing) {
  return surface_point(surface, methods(surface.shape).point(surface.shape, line, crossing),
                       line.clock.start + crossing.t * line.clock.rate);
}

namespace {

/// What the motion says of the matter, in local coordinates: its own texture is what it takes along.
LocalPoint with_motion(const PlacedSurface& surface, const MatterMotion& motion, LocalPoint point,
                       double time) {
  Mat3 rest_from_local(1.0);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) rest_from_local[c][r] = surface.lanes.rest_from_local.column[c][r];
  if (!point.moves) point.velocity = motion.velocity(point.position, time);
  point.moves = true;
  if (motion.counts_time()) point.own_time = motion.own_time(point.position, time, rest_from_local);
  if (const Shape* body = motion.body_shape(); body != nullptr) {
    LocalPoint of_body{.position = motion.body_point(point.position, time)};
    texture_of_body(*body, of_body);
    point.u = of_body.u;
    point.v = of_body.v;
  }
  return point;
}

}  // namespace

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
  if (surface.lanes.is_carried) return carried_point(surface, point, time);
  const MatterMotion* motion = surface.shape.motion.get();
  SurfacePoint placed =
      placed_point(surface, motion != nullptr ? with_motion(surface, *motion, point, time) : point);
  if (!placed.moves) placed.own_time = time;
  return placed;
}

}  // namespace backlight
