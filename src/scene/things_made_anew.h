// Numbers that change from image to image though nothing moves.
#pragma once

#include "backlight/base/diagnostics.h"
#include "backlight/scene/description.h"

namespace backlight {

/// Warns of each key of Clock::anew whose number depends on `t`: once a key, at the first place.
void warn_of_things_made_anew(const Description& description, Diagnostics& diagnostics);

}  // namespace backlight
