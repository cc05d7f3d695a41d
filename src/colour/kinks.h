// Where the slope of a reflectance made from RGB jumps, and how steep it is.
#pragma once

#include "backlight/colour/spectral_kernels.h"
#include "backlight/colour/upsampling.h"

namespace backlight {

/// The places, in the camera's wavelengths, where a sigmoid goes over to what it keeps outside 360..830 nm.
struct Kinks {
  struct Kink {
    double nm;
    double jump;  ///< of the slope, per nm of the camera
  };
  Kink list[4];
  int count = 0;
};

/// Those of a spectrum of kind sigmoid or illuminant (of its sigmoid) at `shift` times the wavelengths, as
/// far as they are in the visible range; none for other kinds.
Kinks kinks_of(const SpectrumForm& form, double shift);

/// The greatest slope, per nm, relative to the greatest value that the model allows, to within a few per
/// cent.
double steepness_of(const SigmoidReflectance& shape);

}  // namespace backlight
