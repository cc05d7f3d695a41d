// What a clock at rest shows along a ray.
#pragma once

namespace backlight {

/// The proper time of a surface's rest frame at the ray's points: start + λ rate, in the frame's units (c =
/// 1). Only formulas of t ask for it.
struct RayClock {
  double start = 0.0;
  double rate = 0.0;
};

}  // namespace backlight
