// A data channel as a picture: colours for its values, and a scale that says what they are.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "backlight/base/result.h"
#include "backlight/film/exr.h"
#include "backlight/film/false_colour.h"
#include "backlight/film/png.h"

namespace backlight {

/// The values that a scale of colours goes over, from its first colour to its last.
struct ColourScale {
  double least = 0.0;
  double greatest = 1.0;
  bool logarithmic = false;
  bool whole = false;  ///< of whole numbers
  ColourMap map = ColourMap::viridis;

  /// 0..1 within the scale.
  [[nodiscard]] double place_of(double value) const;
};

/// Numbers at which a scale has marks: round ones, at most so many.
std::vector<double> marks_of(const ColourScale& scale, int most);

/// The channel of a picture that a name means: its own, as in "P.X" or "light.Y", or that of a layer with one
/// channel, as in "doppler". Fails with the names that there are.
Result<std::size_t> channel_meant(const ImageLayout& layout, const std::string& name, std::size_t view);

/// Collects the values of a channel over all the images that are to be shown alike.
class ChannelValues {
 public:
  void add(const Image& image, std::size_t channel, std::size_t view);
  /// For a channel of this name without its view: "doppler.D".
  [[nodiscard]] ColourScale scale_for(const std::string& channel) const;
  [[nodiscard]] bool empty() const { return !(least_ <= greatest_); }

 private:
  // Of finite values, where there is something.
  double least_ = std::numeric_limits<double>::infinity();
  double greatest_ = -std::numeric_limits<double>::infinity();
};

/// The picture with its scale, marks and what they are of, below. Pixels where the channel tells nothing (no
/// surface; not rendered yet; no light) are grey, NaN magenta.
Result<PixelBytes> show_channel(const ExrPicture& picture, std::size_t channel, std::size_t view,
                                const ColourScale& scale);

}  // namespace backlight
