#include "backlight/render/image_faults.h"

#include <cmath>

namespace backlight {

ImageFaults faults_of(const Image& image) {
  ImageFaults faults;
  const PixelBox& data = image.layout().data;
  for (int y = data.y0; y < data.y1; ++y) {
    for (int x = data.x0; x < data.x1; ++x) {
      bool finite = true;
      bool fits = true;
      for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
        const float value = image.at(channel, x, y);
        finite &= std::isfinite(value);
        const bool half = image.layout().channels[channel].precision == ChannelPrecision::half;
        fits &= !half || fits_half(value);
      }
      if (!finite && faults.non_finite++ == 0) faults.first_non_finite = {x, y};
      if (finite && !fits) ++faults.beyond_half;
    }
  }
  return faults;
}

}  // namespace backlight
