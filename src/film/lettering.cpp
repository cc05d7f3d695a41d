#include "backlight/film/lettering.h"

#include <algorithm>

#include "image_module.h"

namespace backlight {

Result<void> write_text(PixelBytes& picture, const Lettering& lettering) {
  const Result<ImageModule> module = ImageModule::load();
  if (!module.ok()) return module.failure();
  const std::array<float, 3> colour{lettering.colour[0] / 255.0F, lettering.colour[1] / 255.0F,
                                    lettering.colour[2] / 255.0F};
  const int side = lettering.side == TextSide::left ? -1 : lettering.side == TextSide::right ? 1 : 0;
  return module.value().write_text(picture.samples.data(), picture.width, picture.height, lettering.x,
                                   lettering.y, side, lettering.size, colour.data(), lettering.text.c_str());
}

int fitting_size(const std::string& text, int width, int greatest) {
  // Bytes that begin a character.
  const auto letters = std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; });
  const double size = width / (0.62 * static_cast<double>(std::max<std::ptrdiff_t>(letters, 1)));
  return std::clamp(static_cast<int>(size), 7, std::max(greatest, 7));
}

}  // namespace backlight
