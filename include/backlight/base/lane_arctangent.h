// The direction of a point of the plane over lanes, with the same bits for any number of lanes, which libm's
// atan2 does not promise.
//
// The quotient of the smaller and the larger coordinate, or beyond tan(π/8) that of their difference and sum,
// is within ±tan(π/8); there the arc tangent is its Taylor series to z^41/41, cut off by less than 1e-17. The
// absolute error is below 5e-16 (measured in tests/unit/base).
#pragma once

#include "backlight/base/lanes.h"

namespace backlight {

/// The angle of (x, y) from the x axis, in [-π, π]; 0 of the origin.
template <class V>
BACKLIGHT_LANES V angle_of(V y, V x) {
  constexpr double quarter = 0.78539816339744830962;
  const V across = magnitude(x), up = magnitude(y), zero(0.0);
  const V most = larger(across, up), least = smaller(across, up);
  const auto steep = least > V(0.41421356237309503) * most;
  const V below = select(steep, most + least, most);
  const V z = select(steep, least - most, least) / select(below > zero, below, V(1.0));
  // Every other term by itself: half as long to wait for.
  const V q = z * z, square = q * q;
  V even = 1.0 / 41.0, odd = -1.0 / 39.0;
  even = even * square + V(1.0 / 37.0);
  odd = odd * square - V(1.0 / 35.0);
  even = even * square + V(1.0 / 33.0);
  odd = odd * square - V(1.0 / 31.0);
  even = even * square + V(1.0 / 29.0);
  odd = odd * square - V(1.0 / 27.0);
  even = even * square + V(1.0 / 25.0);
  odd = odd * square - V(1.0 / 23.0);
  even = even * square + V(1.0 / 21.0);
  odd = odd * square - V(1.0 / 19.0);
  even = even * square + V(1.0 / 17.0);
  odd = odd * square - V(1.0 / 15.0);
  even = even * square + V(1.0 / 13.0);
  odd = odd * square - V(1.0 / 11.0);
  even = even * square + V(1.0 / 9.0);
  odd = odd * square - V(1.0 / 7.0);
  even = even * square + V(1.0 / 5.0);
  odd = odd * square - V(1.0 / 3.0);
  const V angle = z + z * q * (odd + q * even);
  const V from_axis = select(steep, V(quarter) + angle, angle);
  const V from_x = select(up > across, V(2.0 * quarter) - from_axis, from_axis);
  const V turned = select(x < zero, V(4.0 * quarter) - from_x, from_x);
  return select(y < zero, -turned, turned);
}

}  // namespace backlight
