#include "backlight/render/image_faults.h"

#include <cmath>
#include <limits>

namespace backlight {
namespace {

// Nearly every image is.
bool is_without_fault(const Image& image) {
  for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
    const bool half = image.layout().channels[channel].precision == ChannelPrecision::half;
    const float greatest = half ? greatest_half : std::numeric_limits<float>::max();
    if (!all_within(image.plane(channel), greatest)) return false;
  }
  return true;
}

}  // namespace

ImageFaults faults_of(const Image& image) {
  ImageFaults faults;
  if (is_without_fault(image)) return faults;
  const PixelBox& data = image.layout().data;
  for (int y = data.y0; y < data.y1; ++y) {
    for (int x = data.x0; x < data.x1; ++x) {
      bool finite = true;
      bool fits = true;
      bool saturated = false;
      for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
        const float value = image.at(channel, x, y);
        finite &= std::isfinite(value);
        const bool half = image.layout().channels[channel].precision == ChannelPrecision::half;
        fits &= !half || fits_half(value);
        saturated |= half && std::abs(value) == std::numeric_limits<float>::max();
      }
      if (!finite && faults.non_finite++ == 0) faults.first_non_finite = {x, y};
      if (finite && !fits) ++faults.beyond_half;
      if (saturated) ++faults.saturated;
    }
  }
  return faults;
}

}  // namespace backlight
