// The stretch of a line inside a convex body.
#pragma once

#include "closed_forms.h"
#include "shape_table.h"

namespace backlight {

/// With the faces at its ends; LaneStretch of one lane.
struct Stretch {
  double in = -infinite;
  double out = infinite;
  int part_in = 0;
  int part_out = 0;

  Stretch() = default;
  explicit Stretch(const LaneStretch<Lanes<1>>& lane)
      : in(lane.in.v),
        out(lane.out.v),
        part_in(static_cast<int>(lane.part_in.v)),
        part_out(static_cast<int>(lane.part_out.v)) {}

  void close() { out = -infinite; }
};

}  // namespace backlight
