#include "backlight/trace/rest_colours.h"

#include "backlight/colour/upsampling.h"

namespace backlight {
namespace {

LinearRgb product(const Colour& light, const Colour& reflectance) {
  const bool plain = light.spectrum.is_d65_shaped() || reflectance.spectrum.is_grey();
  return plain ? light.rgb * reflectance.rgb : colour_under(light.spectrum, reflectance.spectrum);
}

}  // namespace

RestColours::RestColours(const Scene& scene, const WavelengthSet& wavelengths)
    : materials_(scene.materials.size()), wavelengths_(wavelengths.nm().begin(), wavelengths.nm().end()) {
  table_.reserve(scene.lights.size() * materials_ * 2);
  for (const Light& light : scene.lights) {
    for (const Material& m : scene.materials) {
      table_.push_back(product(light.colour, m.checker ? m.checker->colours[0] : m.reflectance));
      table_.push_back(m.checker ? product(light.colour, m.checker->colours[1]) : LinearRgb{0.0});
    }
    Lamp lamp{light.colour.rgb, {}};
    for (int i = 0; i < wavelengths.size() && !light.colour.spectrum.is_d65_shaped(); ++i) {
      lamp.film.push_back(light.colour.spectrum.at(wavelengths_[static_cast<std::size_t>(i)]) *
                          wavelengths.weight(i));
    }
    lamps_.push_back(std::move(lamp));
  }
}

LinearRgb RestColours::under(std::size_t light, const LinearRgb& texel) const {
  const Lamp& lamp = lamps_[light];
  if (lamp.film.empty()) return texel * lamp.rgb;
  const SigmoidReflectance reflectance = upsample(texel);
  LinearRgb sum{0.0};
  for (std::size_t i = 0; i < lamp.film.size(); ++i) sum += reflectance.at(wavelengths_[i]) * lamp.film[i];
  return sum;
}

}  // namespace backlight
