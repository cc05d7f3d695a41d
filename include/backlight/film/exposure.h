// How bright a picture is, and the display transform that fits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "backlight/base/result.h"
#include "backlight/film/display.h"

namespace backlight {

/// The luminances of pictures that are to be seen with one transform: a contact sheet, a film. Holds counts,
/// not pixels, so that a film may be as long as it likes.
class LuminanceCounts {
 public:
  LuminanceCounts();

  /// Adds the colour of view number `view`. Fails if there is none.
  Result<void> add(const Image& image, std::size_t view);

  /// The greatest finite luminance; 0 where all is black.
  [[nodiscard]] double greatest() const { return greatest_; }

  /// exp of the mean logarithm, over the pixels brighter than a millionth of the greatest: the log-average
  /// luminance of Reinhard et al. 2002, equation 1, with black space left out. 0 where all is black.
  [[nodiscard]] double log_average() const;

  /// The share of all pixels with a channel above 1.
  [[nodiscard]] double share_beyond_white() const;

 private:
  std::vector<std::uint64_t> counts_;  // by the logarithm of luminance, 1/8 stop each
  std::vector<double> logarithms_;     // their sums
  double greatest_ = 0.0;
  std::uint64_t pixels_ = 0;
  std::uint64_t beyond_white_ = 0;
};

/// The exposure, in stops, that shows the log-average luminance as `key`: 0.18, the middle grey that the
/// paper has for ordinary scenes. 0 where all is black.
double automatic_exposure(const LuminanceCounts& counts, double key = 0.18);

/// What to show pictures with where nothing else was said. As they are, if no more than one pixel in a
/// thousand is beyond white. Else Drago's curve, the log-average luminance exposed to 1 (as that paper has
/// it) and the greatest shown as white: nothing is cut.
DisplayTransform automatic_transform(const LuminanceCounts& counts);

}  // namespace backlight
