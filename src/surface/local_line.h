// A ray brought next to one surface.
//
// From afar, the coordinates of a ray's points near a surface are small differences of large numbers. So each
// surface re-origins the ray at its closest approach to the surface's centre c. With λ₀ = -(o-c)·n/n·n
// *rounded to a double*, the point (o-c) + λ₀n is still a point of the exact ray, and is computed with its
// rounding errors carried along (exact.h): right to about one rounding of its own small coordinates, however
// far away the origin. It is off the closest approach by the rounding of λ₀ alone, which is a shift along the
// ray and is taken out afterwards.
#pragma once

#include <cmath>

#include "backlight/base/vector.h"
#include "backlight/surface/ray_clock.h"
#include "exact.h"
#include "placed_surface.h"

namespace backlight {

/// A ray in the rest frame, with what every surface needs of it.
struct RestRay {
  Vec3 origin;
  Vec3 direction;
  TwoPart direction_split[3];
  double inverse_square;  // 1/n·n
  double inverse_length;  // 1/|n|
  RayClock clock;

  RestRay(const Vec3& from, const Vec3& along, const RayClock& time = {})
      : origin(from),
        direction(along),
        direction_split{split(along.x), split(along.y), split(along.z)},
        inverse_square(1.0 / glm::dot(along, along)),
        inverse_length(std::sqrt(inverse_square)),
        clock(time) {}
};

/// The ray in a surface's local coordinates: point + t·direction, t a local length. `direction` is a unit
/// vector, `point` is the closest approach to the local origin (orthogonal to `direction` up to rounding).
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

/// (o + λ₀n) - c for one coordinate, right to about one rounding of the result.
inline double re_origined(double origin, double centre, double lambda, const TwoPart& lambda_split,
                          double direction, const TwoPart& direction_split) {
  const TwoPart offset = two_sum(origin, -centre);
  const TwoPart along = two_product(lambda, direction, lambda_split, direction_split);
  const TwoPart sum = two_sum(offset.value, along.value);
  return sum.value + (sum.error + (offset.error + along.error));
}

inline LocalLine local_line(const RestRay& ray, const PlacedSurface& surface) {
  const Vec3& centre = surface.placement.position();
  const double lambda = -glm::dot(ray.origin - centre, ray.direction) * ray.inverse_square;
  const TwoPart lambda_split = split(lambda);
  Vec3 near;
  for (int i = 0; i < 3; ++i) {
    near[i] =
        re_origined(ray.origin[i], centre[i], lambda, lambda_split, ray.direction[i], ray.direction_split[i]);
  }
  const Vec3 point = surface.to_local(near);
  const Vec3 direction = surface.to_local(ray.direction);
  const double per_length =
      surface.aligned ? ray.inverse_length : 1.0 / std::sqrt(glm::dot(direction, direction));
  const Vec3 unit = direction * per_length;
  const double shift = -glm::dot(point, unit);
  const RayClock clock{ray.clock.start + (lambda + shift * per_length) * ray.clock.rate,
                       per_length * ray.clock.rate};
  return {point + shift * unit, unit, lambda, shift * per_length, per_length, clock};
}

}  // namespace backlight
