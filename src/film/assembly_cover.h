// Which pixels of a window no box covers.
#pragma once

#include <vector>

#include "backlight/film/image.h"

namespace backlight {

/// The pixels of `window` that are in none of `boxes`, as boxes that do not overlap: from top to bottom, and
/// as high as the gap between their neighbours stays the same.
std::vector<PixelBox> uncovered(const PixelBox& window, const std::vector<PixelBox>& boxes);

}  // namespace backlight
