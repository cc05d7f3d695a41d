// Points of implicit surfaces: many at once.
#pragma once

#include <span>

#include "shape_table.h"

namespace backlight {

// Beside the two corners of the bounds, `values` of an implicit shape hold:
namespace implicit_value {
inline constexpr std::size_t time_scale = 6;  ///< seconds_per_length
inline constexpr std::size_t skips = 7;       ///< 1: unresolved roots are no surface
inline constexpr std::size_t finder = 8;      ///< the RootFinder of first roots
}  // namespace implicit_value

/// Parts 1..6: the faces of the bounds, where they cut the inside.
inline constexpr int implicit_caps = 1;

inline Vec3 implicit_low(const Shape& shape) {
  return {shape.values[0], shape.values[1], shape.values[2]};
}
inline Vec3 implicit_high(const Shape& shape) {
  return {shape.values[3], shape.values[4], shape.values[5]};
}

/// The method `points` of implicit shapes. What is found of a point does not depend on the others.
void implicit_points(const Shape& shape, const LocalLines& lines, std::span<const Crossing> crossings,
                     TextureCoordinates wanted, std::span<LocalPoint> points);

}  // namespace backlight
