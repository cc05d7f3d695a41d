#include "backlight/film/false_colour.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "image_module.h"

namespace backlight {

Result<PixelBytes> false_colours(std::span<const float> values, int width, int height, ColourMap map) {
  const Result<ImageModule> module = ImageModule::load();
  if (!module.ok()) return module.failure();
  std::vector<float> within(values.size());
  std::transform(values.begin(), values.end(), within.begin(),
                 [](float value) { return std::isnan(value) ? 0.0F : std::clamp(value, 0.0F, 1.0F); });
  PixelBytes pixels{width, height, 3, {}};
  pixels.samples.resize(3 * values.size());
  const char* name = map == ColourMap::inferno ? "inferno" : "viridis";
  const Result<void> mapped =
      module.value().colour_map(within.data(), width, height, name, pixels.samples.data());
  if (!mapped.ok()) return mapped.failure();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    pixels.samples[3 * i] = std::isnan(values[i]) ? 255 : 0;
    pixels.samples[3 * i + 1] = std::isnan(values[i]) ? 0 : 255;
    pixels.samples[3 * i + 2] = 255;
  }
  return pixels;
}

Result<std::string> png_address(const PixelBytes& pixels) {
  const Result<ImageModule> module = ImageModule::load();
  if (!module.ok()) return module.failure();
  const auto png =
      module.value().encode_png(pixels.samples.data(), pixels.width, pixels.height, pixels.channels, 8);
  if (!png.ok()) return png.failure();
  const auto text = module.value().base64(png.value());
  if (!text.ok()) return text.failure();
  return "data:image/png;base64," + text.value();
}

}  // namespace backlight
