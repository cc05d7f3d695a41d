// From red, green, blue to a smooth reflectance spectrum.
#pragma once

#include <algorithm>
#include <cmath>

#include "backlight/colour/rgb.h"

namespace backlight {

/// The reflectance model of Jakob & Hanika, "A Low-Dimensional Function Space for Efficient Spectral
/// Upsampling" (Computer Graphics Forum 38(2), 2019), with bounds of its own: middle + half S(c0 nm^2 + c1 nm
/// + c2) with S(x) = x / sqrt(1 + x^2), always between middle - half and middle + half, which are within
/// 0..1. (Theirs are 0 and 1.) Outside 360..830 nm it keeps its end values.
struct SigmoidReflectance {
  double c0 = 0.0;
  double c1 = 0.0;
  double c2 = 0.0;
  double middle = 0.5;
  double half = 0.5;

  [[nodiscard]] double at(double nm) const {
    const double l = std::clamp(nm, 360.0, 830.0);
    const double x = (c0 * l + c1) * l + c2;
    return middle + half * x / std::sqrt(1.0 + x * x);
  }
};

/// The model for the constant reflectance `value` in [0, 1]; exact at 0 and 1 too.
SigmoidReflectance grey_sigmoid(double value);

/// The model whose colour under D65 (sum over 1 nm) is `rgb`, found by damped Gauss-Newton iteration: to 1e-9
/// everywhere in the cube. At no wavelength is it above twice the largest component of `rgb`, nor further
/// below 1 than twice what the smallest component is. Components are clamped to [0, 1] first. Some hundred
/// sums over the visible range: made for a scene's materials; for a texture see `upsample`.
SigmoidReflectance fit_sigmoid(const LinearRgb& rgb);

/// The same from a table that is computed when the program is built, for use at every hit: eight neighbours
/// are interpolated. It is off by a colour difference that docs/colour.md measures (mean 0.02). Greys are
/// exact. Components are clamped to [0, 1] first.
SigmoidReflectance upsample(const LinearRgb& rgb);

/// The colour under D65 of a reflectance of the model (sum over 1 nm).
LinearRgb reflected_colour(const SigmoidReflectance& reflectance);

}  // namespace backlight
