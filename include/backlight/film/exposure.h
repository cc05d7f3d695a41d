// How bright a picture is, and the display transform that fits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
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

  /// The share of all pixels with a luminance above this one, to an eighth of a stop.
  [[nodiscard]] double share_above(double luminance) const;

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

/// What to show pictures with where nothing else was said. No pixel is ever shown brighter than it is on the
/// film: what is dark stays dark.
///
/// As they are, if no more than one pixel in a thousand is beyond white. Else the luminance that one pixel in
/// a thousand passes is shown as white, and where more than half of the pixels are above 1 they are exposed
/// down until no more than half are. The curve is Reinhard's, or, where that would show more than one pixel
/// in a hundred as next to white, Drago's.
DisplayTransform automatic_transform(const LuminanceCounts& counts);

/// What was asked for of a display transform. What was not follows from the pictures.
struct DisplayChoice {
  std::optional<ToneCurve> tone;         ///< none: as automatic_transform() chooses
  std::optional<double> exposure_stops;  ///< beside what is chosen automatically
  bool automatic_exposure = false;       ///< by the log-average luminance, which becomes middle grey
  std::optional<double> white;           ///< none: DisplayTransform's, or the greatest luminance for drago

  /// Whether it depends on the pictures.
  [[nodiscard]] bool is_automatic() const;

  /// `counts`: of the pictures; looked at only if is_automatic().
  [[nodiscard]] DisplayTransform transform(const LuminanceCounts& counts) const;
};

}  // namespace backlight
