// A formula seen from infinity.
#pragma once

#include <optional>

#include "backlight/expression/expression.h"

namespace backlight {

/// f(s·direction, t) = s^degree · g, with w = 1/s: g is regular at w = 0.
struct ProjectiveFormula {
  /// Of the variables first, second (the two free coordinates of the direction), w, t, and `unknowns` more
  /// that may be anything in [-1, 1].
  Expression g;
  std::size_t unknowns = 0;
};

/// On the face where coordinate `axis` of the direction is `side` (1 or -1). Nothing when the formula does
/// something to what grows that cannot be written in this way.
std::optional<ProjectiveFormula> seen_from_infinity(const Expression& f, int axis, double side);

}  // namespace backlight
