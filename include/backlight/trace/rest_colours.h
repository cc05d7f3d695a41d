// Colours under lamps at rest, for the path without spectra.
#pragma once

#include <cstddef>
#include <vector>

#include "backlight/colour/film_integral.h"
#include "backlight/scene/scene.h"
#include "backlight/trace/scene_spectra.h"

namespace backlight {

/// The film colour of reflectance × lamp, worked out once an image from the spectra, so that the RGB path
/// shows at rest what the spectral path would. (The product of two film colours does so only for a white lamp
/// or a grey surface.)
class RestColours {
 public:
  RestColours() = default;
  /// `spectra` may be empty where there is no need for them.
  RestColours(const Scene& scene, const WavelengthSet& wavelengths, const SceneSpectra& spectra);

  /// Whether any light is not white.
  static bool needs_spectra(const Scene& scene);

  /// Under light `light` of unit strength, of the constant reflectance in `slot` (0, or 0 and 1 of a checker)
  /// of a material.
  [[nodiscard]] const LinearRgb& under(std::size_t light, int material, int slot) const {
    return table_[(light * materials_ + static_cast<std::size_t>(material)) * 2 +
                  static_cast<std::size_t>(slot)];
  }

  /// The same of what a point reflects, components in [0, 1] or NaN.
  [[nodiscard]] LinearRgb under(std::size_t light, const LinearRgb& texel) const;

 private:
  /// A lamp, with the rules by which texels are seen under it; empty ones for a white lamp.
  struct Lamp {
    LinearRgb rgb{0.0};
    FilmQuadrature gentle, steep;
  };

  std::size_t materials_ = 0;
  std::vector<LinearRgb> table_;
  std::vector<Lamp> lamps_;
  const WavelengthSet* wavelengths_ = nullptr;
  double steepest_light_ = 0.0;
};

}  // namespace backlight
