#include "backlight/render/image_faults.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "backlight/film/compare.h"

namespace backlight {
namespace {

// How great a channel's values may be, and which infinity they may be, or 0: Z is infinite where there is
// nothing, lampTime minus infinite where a light does not shine.
struct Allowed {
  bool half;
  float infinite;

  [[nodiscard]] bool is_number(float value) const {
    return std::isfinite(value) || (infinite != 0.0F && value == infinite);
  }
};

float infinity_in(const std::string& channel, const std::vector<std::string>& views) {
  if (names_channel("Z", channel, views) || names_channel("mirror.Z", channel, views))
    return std::numeric_limits<float>::infinity();
  return channel.starts_with("lampTime.") ? -std::numeric_limits<float>::infinity() : 0.0F;
}

std::vector<Allowed> allowed_in(const ImageLayout& layout) {
  std::vector<Allowed> allowed;
  for (const ChannelInfo& channel : layout.channels) {
    allowed.push_back({channel.precision == ChannelPrecision::half, infinity_in(channel.name, layout.views)});
  }
  return allowed;
}

// Nearly every image is.
bool is_without_fault(const Image& image, const std::vector<Allowed>& allowed) {
  for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
    const Allowed& of = allowed[channel];
    const auto is_number = [&of](float value) { return of.is_number(value); };
    const bool good =
        of.infinite != 0.0F
            ? std::ranges::all_of(image.plane(channel), is_number)
            : all_within(image.plane(channel), of.half ? greatest_half : std::numeric_limits<float>::max());
    if (!good) return false;
  }
  return true;
}

bool comes_first(const std::optional<std::pair<int, int>>& a, const std::optional<std::pair<int, int>>& b) {
  if (!a || !b) return a.has_value();
  return std::make_pair(a->second, a->first) < std::make_pair(b->second, b->first);
}

}  // namespace

ImageFaults& ImageFaults::operator+=(const ImageFaults& other) {
  non_finite += other.non_finite;
  saturated += other.saturated;
  beyond_half += other.beyond_half;
  if (comes_first(other.first_non_finite, first_non_finite)) first_non_finite = other.first_non_finite;
  return *this;
}

ImageFaults faults_of(const Image& image) {
  ImageFaults faults;
  const std::vector<Allowed> allowed = allowed_in(image.layout());
  if (is_without_fault(image, allowed)) return faults;
  const PixelBox& data = image.layout().data;
  for (int y = data.y0; y < data.y1; ++y) {
    for (int x = data.x0; x < data.x1; ++x) {
      bool finite = true;
      bool fits = true;
      bool saturated = false;
      for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
        const float value = image.at(channel, x, y);
        finite &= allowed[channel].is_number(value);
        fits &= !allowed[channel].half || fits_half(value);
        saturated |= allowed[channel].half && std::abs(value) == std::numeric_limits<float>::max();
      }
      if (!finite && faults.non_finite++ == 0) faults.first_non_finite = {x, y};
      if (finite && !fits) ++faults.beyond_half;
      if (saturated) ++faults.saturated;
    }
  }
  return faults;
}

}  // namespace backlight
