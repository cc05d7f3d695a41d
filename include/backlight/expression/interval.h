// Closed intervals of real numbers that are certain to hold the values of an expression.
#pragma once

#include <cstdint>
#include <limits>

namespace backlight {

/// What is known of an expression over a whole box, from the best to the worst: the decorations dac, def, trv
/// and ill of IEEE 1788-2015. A change of sign is a root only where the expression is `continuous`: at a pole
/// (1/x, tan), at a jump (floor, mod, the cut of atan2) and at the edge of a domain (log, sqrt, asin) it is
/// not.
enum class Continuity : std::uint8_t {
  continuous,  ///< defined and continuous everywhere in the box
  defined,     ///< defined everywhere, perhaps with jumps
  partial,     ///< perhaps undefined somewhere
  undefined    ///< defined nowhere in the box
};

/// [lower, upper], outward-rounded. Either end may be infinite. `undefined`: lower = infinity > upper.
struct Interval {
  double lower = 0.0;
  double upper = 0.0;
  Continuity continuity = Continuity::continuous;

  [[nodiscard]] bool contains(double x) const { return lower <= x && x <= upper; }
};

/// The interval of one number.
constexpr Interval point(double x) {
  return {x, x, Continuity::continuous};
}

/// An expression along a line: its values over a piece of it, and those of its derivative along it. Where the
/// expression has a kink (abs, min, max) the slope holds the slopes on both sides; where no slope is known it
/// is the whole line of real numbers.
struct IntervalSlope {
  Interval value;
  Interval slope;
};

}  // namespace backlight
