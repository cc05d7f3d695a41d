// Gauss-Newton fit of the sigmoid reflectance, in coefficients that suit it.
#pragma once

#include "backlight/colour/upsampling.h"

namespace backlight::sigmoid {

/// Coefficients in t = (nm - 595) / 235, which is -1..1 over the visible range: x = a t^2 + b t + c.
struct Coefficients {
  double a = 0.0;
  double b = 0.0;
  double c = 0.0;
};

/// How a colour is made of another that is easier to fit: `gain` times that one, or, if `complement`, white
/// less so much. Nothing is then brighter at any wavelength than `gain`, or darker than 1 - `gain`:
/// docs/colour.md.
struct Share {
  LinearRgb rgb;  ///< its largest component is at least 1/2; largest and smallest add up to at most 1
  double gain = 1.0;
  bool complement = false;
};

/// Of a colour with components in [0, 1] that is no grey.
Share share_of(const LinearRgb& rgb);

/// The reflectance of a share: `coefficients` are those of its rgb.
SigmoidReflectance reflectance_of(const Share& share, const Coefficients& coefficients);

/// The colour under D65 of the plain sigmoid.
LinearRgb colour_of(const Coefficients& coefficients);

/// Refines `start` until its colour under D65 is `rgb` (components in [0, 1]) or no step brings it nearer.
Coefficients refine(Coefficients start, const LinearRgb& rgb);

/// The fit from nothing, of a share's rgb: follows the colour from the grey of the same mean value to `rgb`.
Coefficients fit(const LinearRgb& rgb);

}  // namespace backlight::sigmoid
