// The spectra of a scene's colours as an image's wavelengths have them.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "backlight/colour/observer.h"
#include "backlight/scene/scene.h"

namespace backlight {

/// A spectrum, and the set at whose wavelengths it is to be sampled.
struct SeenSpectrum {
  const Spectrum* spectrum = nullptr;
  const WavelengthSet* set = nullptr;
  std::uint32_t number = 0;  ///< no other spectrum's of the scene; 0: it is that of one point
  bool one_lamp_doppler =
      false;  ///< a lamp whose light reaches all points of a frame with one Doppler factor
};

/// Spectra made from red, green and blue, with shapes that give back just these at rest when they are sampled
/// at the image's wavelengths (`WavelengthSet::match`): so both paths show the same there. All others are the
/// scene's own. The scene and the set must outlive it.
class SceneSpectra {
 public:
  SceneSpectra() = default;
  SceneSpectra(const Scene& scene, const WavelengthSet& wavelengths);

  /// Of a material: of its square `slot` (0 or 1) if it has a checker. Not of a texture.
  [[nodiscard]] SeenSpectrum reflectance(int material, int slot) const;
  /// Of a material that emits.
  [[nodiscard]] SeenSpectrum emission(int material) const;
  [[nodiscard]] SeenSpectrum light(std::size_t index) const;
  [[nodiscard]] SeenSpectrum sky() const { return seen(sky_); }
  /// The greatest slope of a coloured light, which what it lights has to be sampled by too.
  [[nodiscard]] double steepest_light() const { return steepest_light_; }

 private:
  struct Matched {
    Spectrum spectrum;
    const WavelengthSet* set = nullptr;
    std::uint32_t number = 0;
  };
  static SeenSpectrum seen(const Matched& m) { return {&m.spectrum, m.set, m.number}; }

  const Scene* scene_ = nullptr;
  const WavelengthSet* wavelengths_ = nullptr;
  std::vector<Matched> reflectances_;               // of all materials...
  std::unordered_map<int, Matched> other_squares_;  // ...and of the second squares of checkers
  std::unordered_map<int, Matched> emissions_;      // those with colours
  std::vector<Matched> lights_;
  Matched sky_;
  double steepest_light_ = 0.0;
};

}  // namespace backlight
