// What a checked tree's names refer to: duplicates, missing and unused definitions, circles.
#pragma once

#include <vector>

#include "backlight/base/diagnostics.h"
#include "backlight/scene/description.h"

namespace backlight {

/// Checks the names of a tree that check_structure() has gone through, and orders the parameters. A reference
/// to nothing becomes Invalid. `used` says which variables any expression uses. Unused definitions are warned
/// of where they stand in the scene file itself: an included file may well hold more than one scene needs.
void check_references(Description& description, const std::vector<bool>& used, Diagnostics& diagnostics);

}  // namespace backlight
