// The observer: from a radiance known at a few wavelengths to the red, green and blue of the film.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "backlight/colour/rgb.h"
#include "backlight/colour/shifted_daylight.h"
#include "backlight/colour/spectral_kernels.h"

namespace backlight {

/// The range of the CIE tables in nm. What is outside is invisible, by definition.
inline constexpr double visible_begin_nm = 360.0;
inline constexpr double visible_end_nm = 830.0;

/// How many wavelengths carry a colour unless something else is asked for. docs/colour.md has the measured
/// error for other counts.
inline constexpr int default_wavelength_count = 56;

/// Wavelengths at which a radiance is to be sampled, in the camera's frame, and the weights that make a film
/// colour of the samples. Deterministic: every ray samples the same wavelengths, so there is no colour noise.
///
/// The wavelengths stand at equal shares of a density that is 7/10 uniform and 3/10 the square root of the
/// sum of the CIE 1931 colour-matching functions, both ends included. The weights integrate the natural cubic
/// spline through the samples against the colour-matching functions' 1 nm table, and are scaled so that
/// `Spectrum::d65()` gives (1, 1, 1).
class WavelengthSet {
 public:
  /// `count` >= 4 wavelengths.
  explicit WavelengthSet(int count = default_wavelength_count);

  [[nodiscard]] int size() const { return static_cast<int>(nm_.size()); }

  /// The wavelengths in nm, ascending from 360 to 830, in the camera's frame.
  [[nodiscard]] std::span<const double> nm() const { return nm_; }

  /// The linear colour of the spectral radiance radiance[i] at nm()[i], relative to `Spectrum::d65()`.
  [[nodiscard]] LinearRgb film(const double* radiance) const;
  [[nodiscard]] LinearRgb film(const double* radiance, const SpectralKernels& kernels) const;

  /// The same of the radiance lamp[i] reflectance[i].
  [[nodiscard]] LinearRgb film(const double* lamp, const double* reflectance,
                               const SpectralKernels& kernels) const;

  /// What a radiance 1 at nm()[i] alone adds to the film.
  [[nodiscard]] LinearRgb weight(int i) const;

  /// D65 at shifted wavelengths of this set. Copies share it.
  [[nodiscard]] const ShiftedDaylight& daylight() const { return *daylight_; }

 private:
  std::vector<double> nm_;
  std::vector<double> red_;
  std::vector<double> green_;
  std::vector<double> blue_;
  std::shared_ptr<const ShiftedDaylight> daylight_;
};

/// The set of so many wavelengths, made when it is first asked for: the images of a process share it. From
/// any thread.
const WavelengthSet& wavelength_set(int count);

/// Colour-matching functions x, y, z of the CIE 1931 standard observer (2 degrees): the 1 nm table,
/// interpolated linearly; 0 outside 360..830 nm.
Xyz colour_matching_functions(double nm);

}  // namespace backlight
