#include "shading_steps.h"

#include <algorithm>
#include <cmath>

#include "backlight/colour/upsampling.h"

namespace backlight {
int checker_slot(const Checker& checker, double u, double v) {
  const double square = std::floor(u / checker.size) + std::floor(v / checker.size);
  return std::fmod(square, 2.0) == 0.0 ? 0 : 1;
}

LinearRgb texture_reflectance(const Material& material, double u, double v) {
  return glm::clamp(material.texture->sample(u, v, TextureEdge::repeat), 0.0, 1.0);
}

double strength_at(const Light& light, double own_time, double c, std::vector<double>& variables) {
  if (!light.flickers) return light.strength;
  variables[0] = own_time / c;
  const double strength = light.strength_of_time.evaluate(variables);
  return strength < 0.0 ? 0.0 : strength;  // NaN stays, and is counted
}

LinearRgb emitted_colour(const Material& material, const WavelengthSet& set, Scratch& s) {
  if (!material.emission) return LinearRgb{0.0};
  material.emission->spectrum.evaluate(s.wavelengths.data(), set.size(), s.lamp.data(), *s.kernels);
  return set.film(s.lamp.data(), *s.kernels);
}

std::optional<double> fill_reflectance(const Material& material, double u, double v, Scratch& s) {
  const int n = static_cast<int>(s.wavelengths.size());
  if (material.texture) {
    const SigmoidReflectance shape = upsample(texture_reflectance(material, u, v));
    const Spectrum texel = Spectrum::sigmoid_reflectance(shape, material.uv, material.ir);
    texel.evaluate(s.wavelengths.data(), n, s.reflectance.data(), *s.kernels);
    return {};
  }
  const Colour& colour =
      material.checker
          ? material.checker->colours[static_cast<std::size_t>(checker_slot(*material.checker, u, v))]
          : material.reflectance;
  if (colour.spectrum.is_grey()) return colour.spectrum.at(visible_begin_nm);
  colour.spectrum.evaluate(s.wavelengths.data(), n, s.reflectance.data(), *s.kernels);
  return {};
}

LampColours lamp_colours(const Light& light, DopplerFactor<Rest, Source> doppler, const Material& material,
                         std::optional<double> grey, const WavelengthSet& set, Scratch& s) {
  for (std::size_t i = 0; i < s.wavelengths.size(); ++i) {
    s.at_light[i] = wavelength_at_origin(doppler, s.wavelengths[i]);
  }
  light.colour.spectrum.evaluate(s.at_light.data(), set.size(), s.lamp.data(), *s.kernels);
  LampColours colours;
  if (grey || material.specular > 0.0) colours.whole = set.film(s.lamp.data(), *s.kernels);
  colours.reflected =
      grey ? *grey * colours.whole : set.film(s.lamp.data(), s.reflectance.data(), *s.kernels);
  return colours;
}

}  // namespace backlight
