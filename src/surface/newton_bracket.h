// Newton's method inside a bracket that is halved when Newton's steps do not do better.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace backlight {

struct NewtonBracket {
  double begin, end;  ///< the root is between
  bool positive_before;
  double least;  ///< a few roundings of the coordinates
  /// A step from t is off by no more than this times its square, where that is known.
  double bend = std::numeric_limits<double>::infinity();
  int steps = 0;

  static constexpr int most_steps = 200;

  /// With the value and the slope at t. True: t is the root; else it is where to look next.
  bool improve(double& t, double value, double slope) {
    const double width = end - begin;
    ((value > 0.0) == positive_before ? begin : end) = t;
    if (value == 0.0) return true;
    // Where the slope is infinite there is no step: the bracket is halved.
    double next = std::isinf(slope) ? std::numeric_limits<double>::infinity() : t - value / slope;
    const double off = std::abs(next - t);
    if (off <= 0.03125 * least || bend * off * off <= 0x1p-10 * least) {
      t = std::clamp(next, begin, end);
      return true;
    }
    const bool slow = steps > 6 && end - begin > 0.5 * width;
    if (slow || !(next > begin && next < end)) next = 0.5 * begin + 0.5 * end;
    if (!(next > begin && next < end && ++steps < most_steps)) return true;
    t = next;
    return false;
  }
};

}  // namespace backlight
