#include "backlight/film/false_colour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "image_module.h"

namespace backlight {

namespace {

// Between colours at equal distances, 0..1.
void shift_colour(float value, std::uint8_t* rgb) {
  constexpr std::array<std::array<float, 3>, 5> colours{
      {{110, 15, 25}, {224, 122, 86}, {247, 247, 247}, {96, 154, 216}, {16, 50, 116}}};
  const float place = 4.0F * value;
  const auto below = std::min(static_cast<std::size_t>(place), std::size_t{3});
  const float share = place - static_cast<float>(below);
  for (std::size_t c = 0; c < 3; ++c) {
    const float mixed = colours[below][c] + share * (colours[below + 1][c] - colours[below][c]);
    rgb[c] = static_cast<std::uint8_t>(mixed + 0.5F);
  }
}

Result<void> map_colours(const std::vector<float>& within, ColourMap map, PixelBytes& pixels) {
  if (map == ColourMap::shift) {
    for (std::size_t i = 0; i < within.size(); ++i) shift_colour(within[i], &pixels.samples[3 * i]);
    return {};
  }
  const Result<ImageModule> module = ImageModule::load();
  if (!module.ok()) return module.failure();
  const char* name = map == ColourMap::inferno ? "inferno" : "viridis";
  return module.value().colour_map(within.data(), pixels.width, pixels.height, name, pixels.samples.data());
}

}  // namespace

Result<PixelBytes> false_colours(std::span<const float> values, int width, int height, ColourMap map) {
  std::vector<float> within(values.size());
  std::transform(values.begin(), values.end(), within.begin(),
                 [](float value) { return std::isnan(value) ? 0.0F : std::clamp(value, 0.0F, 1.0F); });
  PixelBytes pixels{width, height, 3, {}};
  pixels.samples.resize(3 * values.size());
  const Result<void> mapped = map_colours(within, map, pixels);
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
