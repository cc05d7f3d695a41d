// The stretch of a line inside a convex body, narrowed face by face.
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

}  // namespace backlight
