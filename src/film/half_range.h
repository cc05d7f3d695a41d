// What half precision can hold.
#pragma once

#include <cmath>

namespace backlight {

constexpr float greatest_half = 65504.0F;

/// Infinities and NaNs have their counterparts in half.
inline bool fits_half(float value) {
  return !std::isfinite(value) || std::abs(value) <= greatest_half;
}

}  // namespace backlight
