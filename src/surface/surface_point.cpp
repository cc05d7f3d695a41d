#include "surface_point.h"

namespace backlight {

SurfacePoint surface_point(const PlacedSurface& surface, const LocalLine& line, const Crossing& crossing) {
  return surface_point(surface, methods(surface.shape).point(surface.shape, line, crossing));
}

SurfacePoint surface_point(const PlacedSurface& surface, const LocalPoint& point) {
  const LanePoint<Lanes<1>> placed = in_rest_frame<Lanes<1>>(
      surface.lanes, {one_lane(point.position), one_lane(point.gradient), point.error}, point.is_unit);
  return {vec3(placed.position), vec3(placed.normal), point.u, point.v, point.member, placed.error_bound.v};
}

}  // namespace backlight
