// The observer: from a radiance known at a few wavelengths to the red, green and blue of the film.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "backlight/colour/light_rows.h"
#include "backlight/colour/rgb.h"
#include "backlight/colour/spectral_kernels.h"
#include "backlight/colour/upsampling.h"

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
/// sum of the CIE 1931 colour-matching functions, both ends included. What is sampled is interpolated by the
/// natural cubic spline: a reflectance, under a light that is not (`film_under`), or a radiance as a whole
/// (`film`), with weights that are scaled so that `Spectrum::d65()` gives (1, 1, 1).
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

  /// A reflectance without features, sampled.
  struct Sampled {
    const double* values;  ///< at nm()[i] times `shift`
    const Spectrum* spectrum;
    double shift;
  };

  /// The film colour of a light without features at `shift` times the film's wavelengths, under a reflectance
  /// (null: 1). `work`: room for size() numbers.
  LinearRgb film_under(const Spectrum& light, double shift, const Sampled* reflectance, double* work,
                       const SpectralKernels& kernels) const;

  /// The same, of a light that `LightRows` has, divided by the luminance of all of it; of coloured light, by
  /// that of the D65 in it.
  [[nodiscard]] LinearRgb film_per_luminance(const Spectrum& light, double shift, const Sampled* reflectance,
                                             double* work, const SpectralKernels& kernels) const;

  /// The set for a spectrum whose slope is nowhere more than `steepness` per nm: this one, or `fine()`.
  [[nodiscard]] const WavelengthSet& for_steepness(double steepness) const;

  /// The set for steep spectra: of 236 wavelengths, or this one if it has as many.
  [[nodiscard]] const WavelengthSet& fine() const;

  /// How many wavelengths that has.
  [[nodiscard]] int most() const { return fine().size(); }

  /// The shape of a texel's reflectance, and the set for it, which the shape matches.
  struct Upsampled {
    SigmoidReflectance shape;
    const WavelengthSet* set;
  };
  /// `steepness`: of what it is seen under.
  [[nodiscard]] Upsampled upsampled(const LinearRgb& rgb, double steepness) const;

  /// D65 and blackbodies, shifted. Copies share them.
  [[nodiscard]] const LightRows& lights() const { return *lights_; }

  /// The shape near `start` whose colour under D65, at rest, is `rgb` by this set: to 1e-8 of the largest
  /// component, or as near as three of Newton's steps come.
  [[nodiscard]] SigmoidReflectance match(const SigmoidReflectance& start, const LinearRgb& rgb) const;

  /// A spectrum made from RGB (others stay as they are), with the shape that matches its film colour `rgb`.
  [[nodiscard]] Spectrum match(const Spectrum& spectrum, const LinearRgb& rgb) const;

 private:
  LinearRgb film_at(const LightRows::Place& place, const Spectrum& light, double shift,
                    const Sampled* reflectance, double* work, const SpectralKernels& kernels) const;

  std::vector<double> nm_;
  std::vector<double> red_;
  std::vector<double> green_;
  std::vector<double> blue_;
  std::shared_ptr<const LightRows> lights_;
  std::vector<double> places_;  // of nm_ in 595 ± 235 nm
};

/// The greatest slope of a spectrum made from RGB, per nm; 0 for others.
double steepness_of(const Spectrum& spectrum);

/// The set of so many wavelengths, made when it is first asked for: the images of a process share it. From
/// any thread.
const WavelengthSet& wavelength_set(int count);

/// Colour-matching functions x, y, z of the CIE 1931 standard observer (2 degrees): the 1 nm table,
/// interpolated linearly; 0 outside 360..830 nm.
Xyz colour_matching_functions(double nm);

}  // namespace backlight
