// The data channels "light": why a pixel is black.
#pragma once

#include "backlight/scene/scene.h"

namespace backlight {

/// Whether the scene's film asks for them.
bool records_light(const Scene& scene);

/// Whether they ask for the channels "lampTime".
bool records_lamp_times(const Scene& scene);

}  // namespace backlight
