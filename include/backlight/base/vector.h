// Plain 3-vectors and 3x3 matrices (GLM's). They carry no frame: frames are types of the room `spacetime`.
#pragma once

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace backlight {

using Vec3 = glm::dvec3;  ///< Three doubles. Not zeroed by its default constructor: write Vec3{0.0}.
using Mat3 = glm::dmat3;  ///< Three columns: m[c][r].

}  // namespace backlight
