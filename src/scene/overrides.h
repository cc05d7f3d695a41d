// -D path=value: values of the command line put into the tree that a file was read into.
#pragma once

#include <string>
#include <vector>

#include "backlight/base/diagnostics.h"
#include "backlight/scene/description.h"

namespace backlight {

/// Puts each "path=value" into the description's tree, before its check, and adds the source "command line",
/// one override a line. What is wrong with a path is reported there; a key or type that is wrong is left to
/// the check.
void apply_overrides(Description& description, const std::vector<std::string>& overrides,
                     Diagnostics& diagnostics);

}  // namespace backlight
