// What the operations on Bounds share.
#pragma once

#include <algorithm>

#include "bounds.h"

namespace backlight {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double largest = std::numeric_limits<double>::max();

inline Bounds nowhere() {
  return {-infinity, -infinity, Continuity::undefined};
}
inline Bounds everything(Continuity continuity) {
  return {infinity, infinity, continuity};
}
inline Continuity worse(const Bounds& a, const Bounds& b) {
  return std::max(a.continuity, b.continuity);
}
/// The smallest |x| in the interval.
inline double least_magnitude(const Bounds& a) {
  return std::max(0.0, std::max(-a.minus_lower, -a.upper));
}

}  // namespace backlight
