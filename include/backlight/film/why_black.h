// Why pixels of a picture are black.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "backlight/base/result.h"
#include "backlight/film/display.h"

namespace backlight {

enum class WhyBlack {
  missed,    ///< no surface there, and a black sky
  shadowed,  ///< no light reaches the surface
  shifted,   ///< its light would be seen, had the Doppler effect not moved it out of the visible
  faint      ///< its light is there, but too little for this exposure
};
constexpr std::size_t why_black_count = 4;

/// The reasons' names and colours (8-bit sRGB; of the palette of Okabe and Ito 2008, which colour-blind
/// people can tell apart), in the order of WhyBlack.
struct BlackReason {
  const char* name;
  const char* colour_name;
  std::array<std::uint8_t, 3> colour;
};
const std::array<BlackReason, why_black_count>& black_reasons();

using BlackCounts = std::array<std::size_t, why_black_count>;  ///< pixels, in the order of WhyBlack

/// Paints over the black pixels of `shown`, which is view number `view` of `image` under `transform`: those
/// with no 8-bit channel above 7, 0.2 % of white. The others stay. Needs the data channels `light` (light.N,
/// light.Y).
Result<BlackCounts> mark_black(PixelBytes& shown, const Image& image, const DisplayTransform& transform,
                               std::size_t view);

}  // namespace backlight
