// D65 as it arrives from lamps in motion, looked up instead of worked out: most lamps have it.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "backlight/colour/rgb.h"
#include "backlight/colour/spectral_kernels.h"

namespace backlight {

/// Rows of `Spectrum::d65()` at s times the wavelengths of a set, for shifts s that are a power of two times
/// 1 + k/2048; between two rows it goes along straight lines in s. docs/colour.md has the error.
///
/// A row is made when it is first asked for, from any thread, and depends on nothing but its number.
class ShiftedDaylight {
 public:
  /// What one row has.
  struct Row {
    LinearRgb film{0.0};         ///< colour of the whole light
    std::vector<double> values;  ///< at s times each wavelength
  };

  /// Between which rows a shift lies.
  struct Place {
    const Row* low;
    const Row* high;
    double fraction;  ///< of the way from one to the other, in [0, 1)

    [[nodiscard]] LinearRgb film() const { return low->film + fraction * (high->film - low->film); }
    /// Values at s times each wavelength.
    void fill(double* values, const SpectralKernels& kernels) const {
      kernels.mix(low->values.data(), high->values.data(), fraction, static_cast<int>(low->values.size()),
                  values);
    }
  };

  /// Of the set with these wavelengths and weights of the film's channels.
  ShiftedDaylight(std::vector<double> nm, std::vector<double> red, std::vector<double> green,
                  std::vector<double> blue);
  ~ShiftedDaylight();
  ShiftedDaylight(const ShiftedDaylight&) = delete;
  ShiftedDaylight& operator=(const ShiftedDaylight&) = delete;

  /// Empty for a shift below 1/8, or of 8 and more, where D65 is a blackbody and as steep as one.
  [[nodiscard]] std::optional<Place> at(double shift) const;

 private:
  [[nodiscard]] const Row& row(std::size_t index) const;
  [[nodiscard]] std::unique_ptr<const Row> make_row(std::size_t index) const;

  std::vector<double> nm_, red_, green_, blue_;
  mutable std::vector<std::atomic<const Row*>> rows_;
};

}  // namespace backlight
