#include "backlight/film/why_black.h"

#include <algorithm>

namespace backlight {
namespace {

constexpr int brightest_black = 7;

Result<std::size_t> light_channel(const Image& image, const char* base, std::size_t view) {
  const std::string name = channel_name(base, image.layout().views, view);
  const int channel = image.find_channel(name);
  if (channel >= 0) return static_cast<std::size_t>(channel);
  return Failure{"the picture has no channel " + name +
                 ", which tells why pixels are black: render it with --aov light"};
}

WhyBlack reason(double lamps, bool black_without_shift) {
  if (!black_without_shift) return WhyBlack::shifted;
  if (lamps < 0.0) return WhyBlack::missed;
  return lamps > 0.0 ? WhyBlack::faint : WhyBlack::shadowed;
}

}  // namespace

const std::array<BlackReason, why_black_count>& black_reasons() {
  static constexpr std::array<BlackReason, why_black_count> reasons{
      {{"missed", "blue", {0, 114, 178}},
       {"shadowed", "orange", {230, 159, 0}},
       {"shifted out of the visible", "pink", {204, 121, 167}},
       {"too faint", "green", {0, 158, 115}}}};
  return reasons;
}

Result<BlackCounts> mark_black(PixelBytes& shown, const Image& image, const DisplayTransform& transform,
                               std::size_t view) {
  const auto lamps = light_channel(image, "light.N", view);
  if (!lamps.ok()) return lamps.failure();
  const auto unshifted = light_channel(image, "light.Y", view);
  if (!unshifted.ok()) return unshifted.failure();
  BlackCounts counts{};
  for (std::size_t i = 0; i < image.plane(lamps.value()).size(); ++i) {
    const auto pixel = shown.samples.begin() + static_cast<std::ptrdiff_t>(3 * i);
    if (*std::max_element(pixel, pixel + 3) > brightest_black) continue;
    const double grey = transform.apply(Vec3{double(image.plane(unshifted.value())[i])}).g;
    const bool black = 255.0 * linear_to_srgb(grey) < brightest_black + 0.5;
    const auto why = static_cast<std::size_t>(reason(double(image.plane(lamps.value())[i]), black));
    ++counts[why];
    std::copy_n(black_reasons()[why].colour.begin(), 3, pixel);
  }
  return counts;
}

}  // namespace backlight
