// A normal as matter has it that moves in its frame.
#pragma once

#include <cmath>

#include "backlight/base/vector.h"
#include "backlight/spacetime/transform.h"

namespace backlight {

/// Unit. Equation (24): what the normal `g` in the base is for the matter.
inline Vec3 normal_of_matter(const LorentzTransform<Rest, Rest>& matter, const Vec3& g) {
  const Vec3& w = matter.celerity();
  const double gamma = matter.gamma();
  const Vec3 normal = g - glm::dot(g, w) / (gamma * (gamma + 1.0)) * w;
  return (1.0 / std::sqrt(glm::dot(normal, normal))) * normal;
}

}  // namespace backlight
