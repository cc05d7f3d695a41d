// A camera that rides with an object.
#pragma once

#include "compile_parts.h"

namespace backlight {

/// Puts the camera aboard the object that its key `aboard` names: at `position` in the object's own
/// coordinates, turning with it. The lens has been pointed in those coordinates. False if the key is not
/// written.
bool ride(Compilation& c, const TableView& camera);

}  // namespace backlight
