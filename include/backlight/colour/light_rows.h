// Smooth lights as they arrive from lamps in motion, looked up instead of worked out: D65 and blackbodies.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "backlight/colour/rgb.h"
#include "backlight/colour/spectral_kernels.h"

namespace backlight {

class Spectrum;
class SplineWeights;

/// What a shifted light makes of a reflectance that is known at the wavelengths of a set: docs/colour.md,
/// equation (c1). The light itself is summed over the observer's 471 samples, so it may be as uneven or as
/// steep as it likes; the reflectance alone is interpolated.
///
/// There are rows of D65 by its shift s, of each doubling 1024, and rows of blackbodies by temperature times
/// shift, all of which are one family, of each doubling 256. In between, the film colour of the whole light
/// follows the cubic that has the rows' values and slopes, weights the cubic through the four rows around. A
/// row is made when it is first asked for, from any thread, and depends on nothing but its number.
class LightRows {
 public:
  /// What one row has, of light divided by e^log_scale.
  struct Row {
    double log_scale = 0.0;
    double log_slope = 0.0;  ///< by the shift, or by the temperature
    LinearRgb film{0.0};     ///< colour of the whole light
    LinearRgb film_slope{0.0};
    std::vector<double> red, green, blue;  ///< what a reflectance 1 at each wavelength alone adds
    /// What the interpolation of max(0, λ - k) leaves out, for k = 360, 361, ... 830 nm: three numbers each.
    std::vector<float> left_out;
  };

  /// A light at a shift, between two rows. Good until the next one is asked for in the same thread.
  struct Place {
    const Row* low;
    const Row* high;
    double fraction;                   ///< of the way from one to the other, in [0, 1)
    double step;                       ///< of shift or temperature between them
    double scale;                      ///< on what they have
    std::array<const Row*, 4> around;  ///< with those two in it
    std::array<double, 4> share;       ///< of each in the cubic through all four

    /// Colour of the whole light.
    [[nodiscard]] LinearRgb film() const;
    /// Colour under reflectance[i] (or reflectance[i] second[i]) at wavelength i.
    [[nodiscard]] LinearRgb film(const double* reflectance, const double* second,
                                 const SpectralKernels& kernels) const;
    /// What is to be added where the slope of the reflectance jumps by 1 per nm, at `nm` in 360..830.
    [[nodiscard]] LinearRgb left_out(double nm) const;
  };

  /// Of the set with these wavelengths.
  explicit LightRows(std::vector<double> nm);
  ~LightRows();
  LightRows(const LightRows&) = delete;
  LightRows& operator=(const LightRows&) = delete;

  /// D65, a blackbody, or the D65 in an illuminant, at `shift` > 0 times each wavelength; empty for others.
  [[nodiscard]] std::optional<Place> at(const Spectrum& light, double shift) const;

 private:
  using Rows = std::vector<std::atomic<const Row*>>;

  [[nodiscard]] Place daylight(double shift, double scale) const;
  [[nodiscard]] Place body(double kelvin, double log_divisor, double scale) const;
  template <class Range, class Make>
  [[nodiscard]] Place between(Rows& rows, const Range& range, double x, const Make& make) const;
  template <class Make>
  [[nodiscard]] const Row& row(Rows& rows, std::size_t index, const Make& make) const;
  [[nodiscard]] Row make_daylight(double shift) const;
  [[nodiscard]] Row make_body(double kelvin) const;
  void fill_weights(const std::array<double, 471>& light, Row& row) const;

  std::unique_ptr<const SplineWeights> spline_;
  mutable Rows daylight_, bodies_;
};

}  // namespace backlight
