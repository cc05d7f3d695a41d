// Which channels an image has, and how a pixel's numbers go into them.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "backlight/film/image.h"
#include "backlight/trace/sheet_tracer.h"

namespace backlight {

/// The layout of the scene's image: colour, the data channels asked for, views.
ImageLayout layout_of(const Scene& scene, const PixelBox& data_window);

/// Whether any data channel is asked for.
bool has_data_channels(const Scene& scene);

/// Whether those of the light that reaches a surface are asked for, which cost as much as the colour.
bool has_light_channels(const Scene& scene);

/// What the data channels tell of a pixel.
struct PixelData {
  SurfaceRecord surface;               ///< of the ray through its centre
  int samples = 0;                     ///< that its colour is the mean of
  std::span<const double> lamp_times;  ///< by light, where they are asked for
};

/// A colour of which a component passes the greatest float, darkened until that one is the greatest float:
/// its hue stays (image_faults.h counts such pixels). Others as they are, infinities and NaNs among them.
LinearRgb saturated(const LinearRgb& rgb);

/// Writes one view's pixels, by the channel order of layout_of.
class PixelWriter {
 public:
  /// `image` has the scene's channels, and any rows.
  PixelWriter(const Scene& scene, Image& image, std::size_t view);

  /// Each returns whether all it wrote is finite as a float, or is as it should be: infinitely far, where the
  /// ray meets nothing; minus infinity, where a light does not reach the point. `at`: the image's offset(). A
  /// colour beyond the greatest float is written as bright as a float can be (`saturated`).
  bool colour(std::size_t at, const LinearRgb& rgb, double alpha) const {
    float values[4] = {static_cast<float>(rgb.r), static_cast<float>(rgb.g), static_cast<float>(rgb.b),
                       static_cast<float>(alpha)};
    float none = 0.0F;  // a NaN where one of them is not finite
    for (const float value : values) none += value - value;
    if (none != 0.0F) {
      const LinearRgb held = saturated(rgb);
      for (int c = 0; c < 3; ++c) values[c] = static_cast<float>(held[c]);
    }
    for (std::size_t c = 0; c < 4; ++c) colour_[c][at] = values[c];
    return none == 0.0F || (std::isfinite(values[0]) && std::isfinite(values[1]) && std::isfinite(values[2]));
  }
  bool data(int x, int y, const PixelData& data) const;

  /// Fetches a row of so many pixels into the caches: they are going to be written.
  void expect(std::size_t at, std::size_t columns) const;

  /// The colours of a whole block (pixel_blocks.h) of one sample each, which begin at `first` of the tile's
  /// light; returns how many are not finite as floats. `at`: of its first pixel; `width`: of the data window.
  std::uint64_t block(std::size_t at, std::size_t width, const TileLight& light, std::size_t first) const;

 private:
  Image* image_;
  std::size_t first_;             // channel
  std::array<float*, 4> colour_;  // planes
  // A data channel's number, and of a distance whether it is one to nothing: infinite.
  struct Data {
    double (*value)(const PixelData&);
    bool (*to_nothing)(const PixelData&);  // null: it is none
  };
  std::vector<Data> data_;
  bool lamp_times_ = false;  // asked for
};

}  // namespace backlight
