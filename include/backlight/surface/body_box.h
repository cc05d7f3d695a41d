// A box about a body that moves together with others.
#pragma once

#include <memory>

#include "backlight/expression/line_program.h"

namespace backlight {

/// The box |axis[k]·(X - centre)| <= half[k] about a body, in coordinates X that it rests in, and perhaps
/// others with it: docs/physics.md equation (28f).
struct BodyBox {
  /// X of a place and a time in seconds: three results of x, y, z and t. The same one of all those bodies.
  std::shared_ptr<const LineProgram> common;
  double centre[3], axis[3][3], half[3];
};

}  // namespace backlight
