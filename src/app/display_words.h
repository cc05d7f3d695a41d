// How pictures were made of film values, as view and the PNGs of render tell it.
#pragma once

#include <string>
#include <vector>

#include "backlight/film/display.h"

namespace backlight {

/// "shown with --tone ... --exposure ...": the flags that ask for the same. Empty where film values are shown
/// as they are.
std::string words_of(const DisplayTransform& transform);

/// A line for each thing that the screen does not show as it is.
std::vector<std::string> lines_of(const DisplayReport& report);

}  // namespace backlight
