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

SigmoidReflectance in_nanometres(const Coefficients& coefficients);

/// Refines `start` until its colour under D65 is `rgb` (components in [0, 1]) or no step brings it nearer.
Coefficients refine(Coefficients start, const LinearRgb& rgb);

/// The fit from nothing: follows the colour from the grey of the same mean value to `rgb`.
Coefficients fit(const LinearRgb& rgb);

}  // namespace backlight::sigmoid
