// The CIE's own normalisation, for tests.
#pragma once

#include "backlight/colour/observer.h"
#include "backlight/colour/spectrum.h"

namespace backlight {

/// The sum over 1 nm of D65's luminance, which is film Y = 1.
inline double d65_sum() {
  static const double sum = [] {
    double y = 0.0;
    for (int nm = 360; nm <= 830; ++nm) y += Spectrum::d65().at(nm) * colour_matching_functions(nm).y;
    return y;
  }();
  return sum;
}

}  // namespace backlight
