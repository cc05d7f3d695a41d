// A shape with its placement and the bounds that follow from the two.
#pragma once

#include <limits>

#include "backlight/surface/placement.h"
#include "backlight/surface/shape.h"
#include "lane_surface.h"

namespace backlight {

/// An axis-aligned box. Empty by default: lo > hi.
struct AxisBox {
  Vec3 lo{1e308};
  Vec3 hi{-1e308};

  void include(const AxisBox& other) {
    lo = glm::min(lo, other.lo);
    hi = glm::max(hi, other.hi);
  }
};

struct PlacedSurface {
  Shape shape;
  LaneSurface lanes;

  [[nodiscard]] Vec3 position() const { return {lanes.centre[0], lanes.centre[1], lanes.centre[2]}; }
  /// Of the bounding sphere about position(), rest frame, for all times; may be infinite.
  [[nodiscard]] double radius() const {
    return lanes.is_carried ? std::numeric_limits<double>::infinity() : lanes.radius;
  }
};

PlacedSurface place(const Shape& shape, const Placement& placement);

/// The axis-aligned box in rest coordinates of a bounded surface.
AxisBox axis_box(const PlacedSurface& surface);

}  // namespace backlight
