// Words in pictures, through the OpenImageIO module.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "backlight/base/result.h"
#include "backlight/film/png.h"

namespace backlight {

/// Which end of a text is at the place that is given for it.
enum class TextSide { left, middle, right };

/// A line of text (UTF-8) that is to stand in a picture.
struct Lettering {
  std::string text;
  int x = 0;  ///< pixels from the left
  int y = 0;  ///< of the baseline, pixels from the top
  TextSide side = TextSide::left;
  int size = 16;  ///< height of the font in pixels
  std::array<std::uint8_t, 3> colour{255, 255, 255};
};

/// Writes it into a picture of 3 channels, in the machine's sans serif font; what reaches beyond the edges is
/// cut. Fails where the machine has no font.
Result<void> write_text(PixelBytes& picture, const Lettering& lettering);

/// The font size in pixels with which a text is no wider than this, at most `greatest` and at least 7.
/// Letters are counted as 0.62 of the size each, which is wide for all but capitals.
int fitting_size(const std::string& text, int width, int greatest);

}  // namespace backlight
