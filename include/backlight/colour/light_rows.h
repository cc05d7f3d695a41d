// Smooth lights as they arrive from lamps in motion, looked up instead of worked out: D65 and blackbodies.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
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
/// There are rows of D65 by its shift s, of each doubling 128, and rows of blackbodies by temperature times
/// shift, all of which are one family, of each doubling 256, of their weights 64, or 16 above 8192 K. In
/// between, the film colour of the whole light follows the cubic that has the rows' values and slopes,
/// weights the cubic through the four rows around. Rows are computed while Backlight is built; the weights of
/// one are made when they are first asked for, from any thread, and depend on nothing but the row's number.
class LightRows {
 public:
  using Row = LightRow;

  /// What a reflectance makes of that.
  struct Weights {
    const double* of[3];  ///< red, green, blue: what a reflectance 1 at each wavelength alone adds
    /// What the interpolation of max(0, λ - k) leaves out, for k = 360, 361, ... 830 nm: three numbers each,
    /// of floats the first 16 bits. It is a small correction: 0.2 % of it do not matter, but room does.
    const std::uint16_t* left_out;
  };

  /// Which rows: D65's, blackbodies', or a row made for one place.
  enum class Family { daylight, bodies, alone };

  /// A light at a shift, between two rows. Good until the next one is asked for in the same thread.
  struct Place {
    Family family;
    const Row* low;
    const Row* high;
    double fraction;  ///< of the way from one to the other, in [0, 1)
    double step;      ///< of shift or temperature between them
    double scale;     ///< on what they have
    double at;        ///< the shift or the temperature

    /// Colour of the whole light.
    [[nodiscard]] LinearRgb film() const;
  };

  /// The weights of a place, of its scale 1. Good until those of another place are asked for.
  struct Weighting {
    const LightRows* rows;
    std::array<Weights, 4> around;
    std::array<double, 4> share;  ///< of each in the cubic through all four

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

  /// Spectrum::blackbody(kelvin) with its scale looked up, which else is a sum: for use at every hit.
  [[nodiscard]] static Spectrum blackbody(double kelvin);
  /// Of the points (up to 64, one bit each) those at whose shifts the place of a light is such that
  /// ReflectedLight has it; its film() there, as three arrays, and in a fourth the luminances. Arrays have
  /// room for whole registers of eight.
  static std::uint64_t films(const Spectrum& light, const double* shift, std::uint64_t points,
                             double* const (&film)[4], const SpectralKernels& kernels);

  [[nodiscard]] Weighting weighting(const Place& place) const;

  /// Those of D65 at rest.
  [[nodiscard]] Weights of_white() const;

 private:
  static constexpr std::size_t left_out_count = 3 * std::size_t{471};
  /// Room for the weights of every row of a family.
  struct Shelf {
    Shelf(std::size_t rows, std::size_t wavelengths);
    std::mutex filling;
    std::vector<std::atomic<bool>> there;
    std::unique_ptr<double[]> weights;  // red, green and blue of each row
    std::unique_ptr<std::uint16_t[]> left_out;
  };

  [[nodiscard]] Place body(double kelvin, double log_divisor, double scale) const;
  [[nodiscard]] Weights weights_of(Family family, std::size_t index) const;
  [[nodiscard]] Weights make_weights(const std::array<double, 471>& light) const;

  std::vector<double> nm_;
  std::vector<std::size_t> beyond_;  // of nm_, from each of the observer's samples on
  std::unique_ptr<const SplineWeights> spline_;
  mutable Shelf daylight_, bodies_;
};

}  // namespace backlight
