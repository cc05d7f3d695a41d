#include "backlight/surface/encloses.h"

#include <array>

namespace backlight {

// The first crossing of a line tells, if there is one: of a body without bounds some lines never meet the
// surface, but not all of these can run along a plane or away from it.
bool encloses(const SurfaceSet& surfaces, int surface, const Vec3& place) {
  const BoundingSphere ball = surfaces.bounds(surface);
  if (glm::length(place - ball.centre) > 1.001 * ball.radius) return false;
  constexpr std::array<Vec3, 3> ways{Vec3{0.36, 0.48, 0.8}, Vec3{0.8, -0.36, 0.48}, Vec3{-0.48, -0.8, 0.36}};
  for (const Vec3& way : ways) {
    for (const Vec3& direction : {way, -way}) {
      const Hit hit = surfaces.first_crossing_of(surface, place, direction);
      if (hit.found()) return glm::dot(surfaces.resolve(hit, place, direction).normal, direction) > 0.0;
    }
  }
  return false;
}

}  // namespace backlight
