#include "shading_steps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "backlight/colour/upsampling.h"

namespace backlight {
namespace {

void fill_reflectance(const Material& material, double u, double v, Scratch& s) {
  const int n = static_cast<int>(s.wavelengths.size());
  if (material.texture) {
    const SigmoidReflectance shape = upsample(texture_reflectance(material, u, v));
    if (material.uv || material.ir) {
      const Spectrum levels = Spectrum::sigmoid_reflectance(shape, material.uv, material.ir);
      levels.evaluate(s.wavelengths.data(), n, s.reflectance.data());
    } else {
      for (std::size_t i = 0; i < s.wavelengths.size(); ++i) s.reflectance[i] = shape.at(s.wavelengths[i]);
    }
    return;
  }
  const Colour& colour =
      material.checker
          ? material.checker->colours[static_cast<std::size_t>(checker_slot(*material.checker, u, v))]
          : material.reflectance;
  colour.spectrum.evaluate(s.wavelengths.data(), n, s.reflectance.data());
}

}  // namespace

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

void begin_spectrum(const Material& material, double u, double v, Scratch& s) {
  const int n = static_cast<int>(s.wavelengths.size());
  std::fill(s.radiance.begin(), s.radiance.end(), 0.0);
  if (material.emission) material.emission->spectrum.evaluate(s.wavelengths.data(), n, s.radiance.data());
  fill_reflectance(material, u, v, s);
}

void add_spectrum(const Light& light, DopplerFactor<Rest, Source> doppler, double irradiance, double specular,
                  Scratch& s) {
  const int n = static_cast<int>(s.wavelengths.size());
  for (std::size_t i = 0; i < s.wavelengths.size(); ++i) {
    s.at_light[i] = wavelength_at_origin(doppler, s.wavelengths[i]);
  }
  light.colour.spectrum.evaluate(s.at_light.data(), n, s.lamp.data());
  const double density = irradiance * wavelength_density_factor(doppler);
  for (std::size_t i = 0; i < s.wavelengths.size(); ++i) {
    s.radiance[i] += density * s.lamp[i] * (s.reflectance[i] * std::numbers::inv_pi + specular);
  }
}

}  // namespace backlight
