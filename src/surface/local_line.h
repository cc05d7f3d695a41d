// One ray brought next to one surface: the law of lane_surface.h for one lane.
#pragma once

#include <cmath>

#include "backlight/base/vector.h"
#include "backlight/surface/ray_clock.h"
#include "placed_surface.h"

namespace backlight {

/// A ray in the rest frame.
struct RestRay {
  Vec3 origin;
  Vec3 direction;
  RayClock clock;
};

/// LaneLine of one lane, with its clock.
struct LocalLine {
  Vec3 point;
  Vec3 direction;
  double lambda_centre;  // λ(t) = lambda_centre + (lambda_shift + t · lambda_per_length)
  double lambda_shift;
  double lambda_per_length;
  RayClock clock;  // along t, not λ

  [[nodiscard]] double lambda(double t) const {
    return lambda_centre + (lambda_shift + t * lambda_per_length);
  }
  [[nodiscard]] Vec3 at(double t) const { return point + t * direction; }
};

inline LaneVec3<Lanes<1>> one_lane(const Vec3& a) {
  return {a.x, a.y, a.z};
}
inline LaneRay<Lanes<1>> one_lane(const RestRay& ray) {
  return {one_lane(ray.origin), one_lane(ray.direction)};
}
inline LaneLine<Lanes<1>> one_lane(const LocalLine& line) {
  return {one_lane(line.point), one_lane(line.direction), line.lambda_centre, line.lambda_shift,
          line.lambda_per_length};
}
inline Vec3 vec3(const LaneVec3<Lanes<1>>& a) {
  return {a.x.v, a.y.v, a.z.v};
}

inline LocalLine local_line(const RestRay& ray, const PlacedSurface& surface) {
  const LaneLine<Lanes<1>> line = lane_line(surface.lanes, one_lane(ray));
  const double centre = line.lambda_centre.v, shift = line.lambda_shift.v,
               per_length = line.lambda_per_length.v;
  const RayClock clock{ray.clock.start + (centre + shift) * ray.clock.rate, per_length * ray.clock.rate};
  return {vec3(line.point), vec3(line.direction), centre, shift, per_length, clock};
}

}  // namespace backlight
