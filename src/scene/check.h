// The check of a tree against the table of keys: unknown keys, types, missing keys. Strings in the place of
// numbers become expressions here.
#pragma once

#include <vector>

#include "backlight/base/diagnostics.h"
#include "backlight/scene/description.h"

namespace backlight {

/// Fills Description::variables with "t", "frame", "image_time" and the parameters that have usable names.
void collect_variables(Description& description, Diagnostics& diagnostics);

/// Checks the description's tree. What is wrong becomes Invalid. Returns, for each variable, whether any
/// expression uses it.
std::vector<bool> check_structure(Description& description, Diagnostics& diagnostics);

}  // namespace backlight
