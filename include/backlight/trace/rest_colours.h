// Colours under lamps at rest, for the path without spectra.
#pragma once

#include <cstddef>
#include <vector>

#include "backlight/colour/observer.h"
#include "backlight/scene/scene.h"

namespace backlight {

/// The film colour of reflectance × lamp, worked out once an image from the spectra, so that the RGB path
/// shows at rest what the spectral path would. (The product of two film colours does so only for a white lamp
/// or a grey surface.)
class RestColours {
 public:
  RestColours() = default;
  RestColours(const Scene& scene, const WavelengthSet& wavelengths);

  /// Under light `light` of unit strength, of the constant reflectance in `slot` (0, or 0 and 1 of a checker)
  /// of a material.
  [[nodiscard]] const LinearRgb& under(std::size_t light, int material, int slot) const {
    return table_[(light * materials_ + static_cast<std::size_t>(material)) * 2 +
                  static_cast<std::size_t>(slot)];
  }

  /// The same of a texture's value, components in [0, 1].
  [[nodiscard]] LinearRgb under(std::size_t light, const LinearRgb& texel) const;

 private:
  /// A lamp as what each wavelength of it adds to the film; no wavelengths for a white lamp.
  struct Lamp {
    LinearRgb rgb{0.0};
    std::vector<LinearRgb> film;
  };

  std::size_t materials_ = 0;
  std::vector<LinearRgb> table_;
  std::vector<double> wavelengths_;
  std::vector<Lamp> lamps_;
};

}  // namespace backlight
