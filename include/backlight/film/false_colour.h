// Numbers as colours, and pictures as text for a page.
#pragma once

#include <span>
#include <string>

#include "backlight/base/result.h"
#include "backlight/film/png.h"

namespace backlight {

/// `inferno` and `viridis` are the maps of matplotlib of these names (S. van der Walt and N. Smith 2015), of
/// even lightness steps. `shift` goes from dark red over white at 0.5 to dark blue, equally dark on both
/// sides: told apart by all who see red and green alike, and by lightness from the middle.
enum class ColourMap { inferno, viridis, shift };

/// Values 0..1, row after row, as sRGB colours of the map; what lies beyond is cut. NaN becomes magenta and
/// infinity cyan, which are in neither map.
Result<PixelBytes> false_colours(std::span<const float> values, int width, int height, ColourMap map);

/// The picture as a PNG in a "data:" address, for a page that needs no other file.
Result<std::string> png_address(const PixelBytes& pixels);

}  // namespace backlight
