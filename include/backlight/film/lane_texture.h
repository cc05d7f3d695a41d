// Texture coordinates over lanes: one lane is the law for one ray, more have the same bits.
#pragma once

#include "backlight/base/lane_arctangent.h"

namespace backlight {

/// Texture coordinates of the sky in a direction in its frame: equirectangular, as an equirectangular camera
/// looking along +z with y up would have made it: u = 1/2 at +z, growing towards -x (its right), v = 0 at +y.
template <class V>
struct LaneSkyPlace {
  V u, v;

  explicit BACKLIGHT_LANES LaneSkyPlace(LaneVec3<V> d)
      : u(V(0.5) + angle_of(-d.x, d.z) * V(0.15915494309189535)),
        v(angle_of(sqrt(d.x * d.x + d.z * d.z), d.y) * V(0.31830988618379067)) {}
};

/// Whether the sum of the numbers of a square, rounded down in both directions, is odd (or not a number).
template <class V>
BACKLIGHT_LANES typename V::Mask is_odd_square(V size, V u, V v) {
  const auto rounded_down = [](V x) __attribute__((always_inline)) {
    const V near = (x + V(0x1.8p52)) - V(0x1.8p52);  // the nearest whole number; beyond 2^51 maybe another
    const V down = select(near > x, near - V(1.0), near);
    return select(magnitude(x) < V(0x1p51), down, x);
  };
  const V half = V(0.5) * (rounded_down(u / size) + rounded_down(v / size));
  return ~(rounded_down(half) == half);
}

}  // namespace backlight
