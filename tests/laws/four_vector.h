// Plain arithmetic of four-vectors, apart from the program's.
#pragma once

#include "matter_scenes.h"

namespace backlight::test {

struct FourVector {
  double t;
  Vec3 x;
};

/// In the frame that moves with this velocity.
inline FourVector boosted(const FourVector& n, const Vec3& velocity) {
  const double gamma = lorentz_factor(velocity);
  const Vec3 u = gamma * velocity;
  const double along = glm::dot(u, n.x);
  return {gamma * n.t - along, n.x + (along / (gamma + 1.0) - n.t) * u};
}

}  // namespace backlight::test
