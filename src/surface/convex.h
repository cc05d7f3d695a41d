// What convex bodies share: the stretch of a line inside, narrowed face by face, and quadratic equations.
#pragma once

#include "shape_table.h"

namespace backlight {

/// The stretch of a line inside a convex body, with the faces at its ends. Bodies are intersected by
/// narrowing: a ray through an edge then either meets both faces or misses both, and can never slip in
/// between.
struct Stretch {
  double in = -infinite;
  double out = infinite;
  int part_in = 0;
  int part_out = 0;

  void narrow(double enter, int enter_part, double leave, int leave_part) {
    if (enter > in) {
      in = enter;
      part_in = enter_part;
    }
    if (leave < out) {
      out = leave;
      part_out = leave_part;
    }
  }
  void close() { out = -infinite; }

  [[nodiscard]] Crossings ends() const {
    Crossings result;
    if (in <= out && in > -infinite && out < infinite) {
      result.add(in, part_in);
      result.add(out, part_out);
    }
    return result;
  }
};

/// |coordinate| <= half, the faces being `low_part` and `low_part` + 1.
inline void narrow_to_slab(Stretch& stretch, double point, double direction, double half, int low_part) {
  if (direction > 0.0) {
    stretch.narrow((-half - point) / direction, low_part, (half - point) / direction, low_part + 1);
  } else if (direction < 0.0) {
    stretch.narrow((half - point) / direction, low_part + 1, (-half - point) / direction, low_part);
  } else if (!(std::abs(point) <= half)) {
    stretch.close();
  }
}

/// The roots of a t² + 2 b t + c, without cancellation: q/a and c/q with q = -(b ± √(b²-ac)), b and the root
/// of the same sign. `discriminant` is b² - ac, non-negative.
struct QuadraticRoots {
  double over_a;  // may be infinite
  double under_c;
};

inline QuadraticRoots quadratic_roots(double a, double b, double c, double discriminant) {
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  if (q == 0.0) {
    return {0.0,
            0.0};  // b = 0 and ac = 0: a double root, or (a = 0) no proper equation, which callers exclude
  }
  return {q / a, c / q};
}

}  // namespace backlight
