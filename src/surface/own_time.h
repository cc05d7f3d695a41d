// What a clock has counted that went along with matter: docs/physics.md equation (25), by quadrature.
#pragma once

#include <functional>
#include <optional>

#include "backlight/base/vector.h"

namespace backlight {

/// √(1 - v²): what a clock counts in a unit of time. Not a number where v > 1.
double clock_rate(const Vec3& velocity);

/// ∫₀^time √(1 - v²) dt of a velocity by time, to about 1e-12 of it: Gauss and Kronrod's rules of 7 and 15
/// points, on halves of an interval where they differ. Not a number where v >= 1. `period`: of the velocity,
/// if one is known; then it takes no longer at any time than over a period.
double own_time_along(const std::function<Vec3(double)>& velocity, double time,
                      std::optional<double> period = {});

/// The same along the way of the matter that is at `place` at `time`, of a velocity by place and time in
/// local coordinates, of which `rest_from_local` makes the frame's: back to time 0 by Dormand and Prince's
/// method of orders 5 and 4.
double own_time_of_flow(const std::function<Vec3(const Vec3&, double)>& velocity, const Mat3& rest_from_local,
                        const Vec3& place, double time);

}  // namespace backlight
