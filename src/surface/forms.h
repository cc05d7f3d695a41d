// Which form the lanes take for a kind of shape.
#pragma once

#include "closed_forms.h"
#include "travelling_ball.h"

namespace backlight {

/// Calls `use` with the closed form of a kind; false: it has none of so few crossings.
template <class Use>
BACKLIGHT_LANES bool with_form(ShapeKind kind, Use&& use) {
  switch (kind) {
    case ShapeKind::sphere:
      use(SphereForm{});
      return true;
    case ShapeKind::box:
      use(BoxForm{});
      return true;
    case ShapeKind::cylinder:
      use(FrustumForm<true>{});
      return true;
    case ShapeKind::cone:
      use(FrustumForm<false>{});
      return true;
    case ShapeKind::disk:
      use(FlatForm<true>{});
      return true;
    case ShapeKind::plane:
      use(FlatForm<false>{});
      return true;
    case ShapeKind::quadric:
      use(QuadricForm{});
      return true;
    case ShapeKind::travelling_ball:
      use(TravellingBallForm{});
      return true;
    default:
      return false;
  }
}

}  // namespace backlight
