// Plain 3-vectors and 3x3 matrices (GLM's). They carry no frame: frames are types of the room `spacetime`.
#pragma once

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace backlight {

using Vec3 = glm::dvec3;  ///< Three doubles. Not zeroed by its default constructor: write Vec3{0.0}.
using Mat3 = glm::dmat3;  ///< Three columns: m[c][r].

/// A direction times the power of two that makes its largest component about 1, so that its square neither
/// over- nor underflows; no digit changes. Zero stays zero, what is not finite stays so.
inline Vec3 of_size_one(const Vec3& direction) {
  const double largest = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  if (!(largest > 0.0) || !std::isfinite(largest)) return direction;
  return std::ldexp(1.0, std::min(1000, -std::ilogb(largest))) * direction;
}

}  // namespace backlight
