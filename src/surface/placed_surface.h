// A shape with its placement and the bounds that follow from the two.
#pragma once

#include "backlight/surface/placement.h"
#include "backlight/surface/shape.h"

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
  Placement placement;
  double radius;  ///< of the bounding sphere about placement.position(), rest frame; may be infinite
  bool aligned;   ///< neither turned nor scaled: local and rest coordinates have the same axes
  bool casts_shadow = true;

  [[nodiscard]] Vec3 to_local(const Vec3& rest) const {
    return aligned ? rest : placement.local_from_rest() * rest;
  }
};

PlacedSurface place(const Shape& shape, const Placement& placement);

/// The axis-aligned box in rest coordinates of a bounded surface.
AxisBox axis_box(const PlacedSurface& surface);

}  // namespace backlight
