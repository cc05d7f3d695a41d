// Cameras that do not move uniformly: what is true of one at the instant of its exposure.
#pragma once

#include <optional>

#include "compile_parts.h"

namespace backlight {

/// A camera without a velocity whose position depends on t: sets celerity, event and proper time of the
/// scene's camera from its path (docs/physics.md, equation 18). False, with nothing done, if it does not
/// move.
bool follow_path(Compilation& c, const TableView& camera);

/// A camera with a rocket (equations 19 to 21). False, with nothing done, if it has none.
bool fly(Compilation& c, const TableView& camera);

/// The unit vector of a rocket's `along`; nothing if it has no direction, which has then been reported.
std::optional<ExtendedVec3> thrust_direction(const TableView& rocket);

}  // namespace backlight
