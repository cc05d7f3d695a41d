// A scene in words: what `backlight check` prints.
#pragma once

#include <string>

#include "backlight/scene/description.h"
#include "backlight/scene/needs.h"
#include "backlight/scene/scene.h"

namespace backlight {

/// The scene's image, camera, frames with their speeds and Lorentz factors, objects, lights, background and
/// effects, and the model that it needs with the reason. Lines end in a newline.
std::string explain(const Description& description, const Scene& scene, const Needs& needs);

}  // namespace backlight
