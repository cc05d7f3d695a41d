// Pictures put beside each other and given words.
#pragma once

#include <string>
#include <vector>

#include "backlight/base/result.h"
#include "backlight/film/png.h"

namespace backlight {

/// Pictures in rows, left to right and top to bottom, each at the top left of a cell of the largest one's
/// size. `columns` 0: as square as it can be.
PixelBytes contact_sheet(const std::vector<PixelBytes>& pictures, int columns);

/// White words at the lower left of the first `height` rows, on a strip of the picture at a third of its
/// brightness.
Result<void> add_label(PixelBytes& pixels, int height, const std::string& text);

}  // namespace backlight
