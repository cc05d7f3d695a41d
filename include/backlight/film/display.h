// From film values to what a screen shows.
#pragma once

#include <array>
#include <cstddef>

#include "backlight/base/result.h"
#include "backlight/base/vector.h"
#include "backlight/film/image.h"
#include "backlight/film/png.h"

namespace backlight {

/// The sRGB transfer curve (IEC 61966-2-1), extended to negative values as an odd function. Linear light 0..1
/// to signal 0..1, and back.
double linear_to_srgb(double linear);
double srgb_to_linear(double signal);

/// The scale on which errors of a film value count as they are seen: the sRGB signal up to white (film 1 is
/// 1; a step of an 8-bit picture is 1/255), and above, where only an exposure makes it visible, on with the
/// same slope logarithmically: 1 + 0.4396 ln v, so that 1 % is 0.0044 at any brightness. Odd, increasing.
double shown_value(double film);

/// How luminance L (after exposure; 1 is a white surface in full light) becomes display luminance.
enum class ToneCurve {
  /// As it is. Each channel is cut at 1.
  none,
  /// L (1 + L / white^2) / (1 + L): nearly linear where dark, 1 at L = white (Reinhard, Stark, Shirley and
  /// Ferwerda 2002, "Photographic Tone Reproduction for Digital Images", equation 4).
  reinhard,
  /// ln(1 + L) / ln(1 + white): equal ratios of bright luminances become equal steps, 1 at L = white (the
  /// logarithmic mapping that Drago et al. 2003, "Adaptive Logarithmic Mapping For Displaying High Contrast
  /// Scenes", start from, equation 1).
  logarithmic,
  /// ln(1 + L) / ln(2 + 8 (L / white)^k) / lg(1 + white), k = ln(0.85) / ln(0.5), 1 at L = white: the
  /// adaptive
  /// mapping itself (equation 4 of that paper, bias 0.85). A logarithm to base 2 where dark, to base 10 where
  /// bright, it keeps contrast at both ends of a range of many powers of ten, such as D^4 gives.
  drago
};

/// Film values (linear Rec.709) to display values. The default shows a film value of 1 as the screen's white
/// and nothing else than what is in the file: pictures with the same setting can be compared. The searchlight
/// effect soon passes white; the curves keep what lies beyond it apart.
///
/// Colours outside Rec.709 (a negative channel) are mixed with the grey of their luminance until no
/// channel is negative: hue and luminance stay, where cutting each channel would change both. The curves work
/// on luminance (BT.709: 0.2126 R + 0.7152 G + 0.0722 B) and treat channels above 1 in the same way.
struct DisplayTransform {
  double exposure_stops = 0.0;  ///< film values are multiplied by 2^exposure_stops
  ToneCurve tone = ToneCurve::none;
  double white = 1000.0;  ///< > 0; what the curves show as white. 1000 = D^4 coming head-on at 0.94 c

  /// Display-linear values in 0..1. NaN if any channel is NaN; infinities count as very large.
  [[nodiscard]] Vec3 apply(const Vec3& film) const;
};

/// What a picture on the screen does not show as it is.
struct DisplayReport {
  std::size_t beyond_white = 0;   ///< pixels with a channel above 1 after exposure
  std::size_t outside_gamut = 0;  ///< pixels with a negative channel
  std::size_t not_a_number = 0;   ///< pixels shown magenta
};

struct DisplayedImage {
  PixelBytes pixels;  ///< RGB, of the data window
  DisplayReport report;
};

/// The numbers of the channels R, G and B of view number `view`. Fails if the picture has not all of them.
Result<std::array<std::size_t, 3>> colour_channels(const Image& image, std::size_t view);

/// The colour of view number `view` as 8-bit sRGB, rounded to nearest. Alpha is not looked at: where it is 0
/// the film is black. NaN is shown magenta. Fails if the picture has no R, G and B in that view.
Result<DisplayedImage> display_image(const Image& image, const DisplayTransform& transform,
                                     std::size_t view = 0);

}  // namespace backlight
