#include <algorithm>
#include <cmath>

#include "backlight/scene/scene.h"

namespace backlight {

double SpotCone::share(const Vec3& direction) const {
  // By the tangent of the angle, which is exact near the axis too.
  const double angle = std::atan2(glm::length(glm::cross(axis, direction)), glm::dot(axis, direction));
  if (!(angle <= half_angle)) return 0.0;
  const double full = half_angle * (1.0 - edge);
  if (angle <= full) return 1.0;
  const double s = (half_angle - angle) / (half_angle - full);
  return s * s * (3.0 - 2.0 * s);
}

}  // namespace backlight
