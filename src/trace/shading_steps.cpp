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
  const double strength = light.strength_of_time.evaluate(variables) / light.strength;
  return strength < 0.0 ? 0.0 : strength;  // NaN stays, and is counted
}

const double* shifted_wavelengths(const WavelengthSet& set, Scratch& s) {
  if (!s.shifted) {
    const DopplerFactor<Camera, Rest> doppler{s.shift};
    for (std::size_t i = 0; i < s.wavelengths.size(); ++i) {
      s.wavelengths[i] = wavelength_at_origin(doppler, set.nm()[i]);
    }
    s.shifted = true;
  }
  return s.wavelengths.data();
}

LinearRgb shifted_colour(const Spectrum& emission, const WavelengthSet& set, Scratch& s) {
  if (const std::optional<double> share = emission.share_of_d65()) {
    if (const auto place = set.daylight().at(s.shift)) return *share * place->film();
  }
  emission.evaluate_light(shifted_wavelengths(set, s), set.size(), s.lamp.data(), *s.kernels);
  return set.film(s.lamp.data(), *s.kernels);
}

LinearRgb emitted_colour(const Material& material, const WavelengthSet& set, Scratch& s) {
  return material.emission ? shifted_colour(material.emission->spectrum, set, s) : LinearRgb{0.0};
}

std::optional<double> fill_reflectance(const Material& material, double u, double v, const WavelengthSet& set,
                                       Scratch& s) {
  if (material.texture) {
    const SigmoidReflectance shape = upsample(texture_reflectance(material, u, v));
    const Spectrum texel = Spectrum::sigmoid_reflectance(shape, material.uv, material.ir);
    texel.evaluate(shifted_wavelengths(set, s), set.size(), s.reflectance.data(), *s.kernels);
    return {};
  }
  const Colour& colour =
      material.checker
          ? material.checker->colours[static_cast<std::size_t>(checker_slot(*material.checker, u, v))]
          : material.reflectance;
  if (colour.spectrum.is_grey()) return colour.spectrum.at(visible_begin_nm);
  colour.spectrum.evaluate(shifted_wavelengths(set, s), set.size(), s.reflectance.data(), *s.kernels);
  return {};
}

namespace {

// Into s.lamp, at D D_j times the film's wavelengths.
void fill_lamp(const Spectrum& lamp, DopplerFactor<Rest, Source> doppler, const WavelengthSet& set,
               Scratch& s) {
  const double* nm = shifted_wavelengths(set, s);
  for (std::size_t i = 0; i < s.wavelengths.size(); ++i) {
    s.at_light[i] = wavelength_at_origin(doppler, nm[i]);
  }
  lamp.evaluate_light(s.at_light.data(), set.size(), s.lamp.data(), *s.kernels);
}

}  // namespace

LampColours lamp_colours(const Light& light, DopplerFactor<Rest, Source> doppler, const Material& material,
                         std::optional<double> grey, const WavelengthSet& set, Scratch& s) {
  const Spectrum& lamp = light.colour.spectrum;
  const bool whole = grey || material.specular > 0.0;
  const std::optional<double> share = lamp.share_of_d65();
  const auto daylight = share ? set.daylight().at(wavelength_at_origin(doppler, s.shift)) : std::nullopt;
  LampColours colours;
  if (daylight) {
    if (whole) colours.whole = *share * daylight->film();
    if (!grey) daylight->fill(s.lamp.data(), *s.kernels);
  } else {
    fill_lamp(lamp, doppler, set, s);
    if (whole) colours.whole = set.film(s.lamp.data(), *s.kernels);
  }
  colours.reflected =
      grey ? *grey * colours.whole
           : (daylight ? *share : 1.0) * set.film(s.lamp.data(), s.reflectance.data(), *s.kernels);
  return colours;
}

}  // namespace backlight
