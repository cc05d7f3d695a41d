#include <algorithm>
#include <array>
#include <cmath>

#include "backlight/scene/scene.h"

namespace backlight {

namespace {

Vec3 axis_at(const TurningAxis& turning, double own_time) {
  Vec3 axis{0.0};
  for (glm::length_t i = 0; i < 3; ++i) {
    const Expression& component = turning.components[static_cast<std::size_t>(i)];
    axis[i] = component.evaluate(std::array{own_time / turning.c});
  }
  return axis;
}

}  // namespace

double SpotCone::share(const Vec3& direction, double own_time) const {
  const Vec3 at = turning ? axis_at(*turning, own_time) : axis;
  // By the tangent of the angle, which is exact near the axis too, and needs no unit vectors.
  const double sine = glm::length(glm::cross(at, direction)), cosine = glm::dot(at, direction);
  if (sine == 0.0 && cosine == 0.0) return 0.0;
  const double angle = std::atan2(sine, cosine);
  if (!(angle <= half_angle)) return 0.0;
  const double full = half_angle * (1.0 - edge);
  if (angle <= full) return 1.0;
  const double s = (half_angle - angle) / (half_angle - full);
  return s * s * (3.0 - 2.0 * s);
}

}  // namespace backlight
