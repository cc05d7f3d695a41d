#include "backlight/trace/scene_spectra.h"

#include <algorithm>

namespace backlight {

SceneSpectra::SceneSpectra(const Scene& scene, const WavelengthSet& wavelengths)
    : scene_(&scene), wavelengths_(&wavelengths) {
  for (const Light& light : scene.lights) {
    steepest_light_ = std::max(steepest_light_, steepness_of(light.colour.spectrum));
  }
  std::uint32_t number = 0;
  const auto matched = [&](const Colour& colour) {
    const double steepness = std::max(steepness_of(colour.spectrum), steepest_light_);
    const WavelengthSet& set = wavelengths.for_steepness(steepness);
    return Matched{set.match(colour.spectrum, colour.rgb), &set, ++number};
  };
  reflectances_.reserve(scene.materials.size());
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    const int index = static_cast<int>(i);
    reflectances_.push_back(matched(material.checker ? material.checker->colours[0] : material.reflectance));
    if (material.checker) other_squares_.emplace(index, matched(material.checker->colours[1]));
    if (material.emission && material.emission->spectrum.shape()) {
      emissions_.emplace(index, matched(*material.emission));
    }
  }
  for (const Light& light : scene.lights) lights_.push_back(matched(light.colour));
  sky_ = matched(scene.sky.radiance);
}

SeenSpectrum SceneSpectra::reflectance(int material, int slot) const {
  return seen(slot == 0 ? reflectances_[static_cast<std::size_t>(material)] : other_squares_.at(material));
}

SeenSpectrum SceneSpectra::light(std::size_t index) const {
  SeenSpectrum light = seen(lights_[index]);
  light.one_lamp_doppler = scene_->lights[index].kind != LightKind::point;
  return light;
}

SeenSpectrum SceneSpectra::emission(int material) const {
  const Spectrum& own = scene_->materials[static_cast<std::size_t>(material)].emission->spectrum;
  return own.shape() ? seen(emissions_.at(material)) : SeenSpectrum{&own, wavelengths_};
}

}  // namespace backlight
