// Steps of shading that one ray and a sheet of rays have in common.
#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include "backlight/trace/shading.h"

namespace backlight {

/// Which of a checker's two colours, by the parity of the square in texture coordinates.
int checker_slot(const Checker& checker, double u, double v);

LinearRgb texture_reflectance(const Material& material, double u, double v);

/// Strength of a lamp at its own time `own_time` (times c); a formula below zero means that the lamp is off.
double strength_at(const Light& light, double own_time, double c, std::vector<double>& variables);

// For shifted colours, docs/physics.md equation (13a). All at s.wavelengths, which are in the surface's
// frame.

/// Sets them: D times the film's.
template <class Rest>
void shift_wavelengths(DopplerFactor<Camera, Rest> doppler, const WavelengthSet& set, Scratch& s) {
  for (std::size_t i = 0; i < s.wavelengths.size(); ++i) {
    s.wavelengths[i] = wavelength_at_origin(doppler, set.nm()[i]);
  }
}

/// The film colour of a surface's own emission.
LinearRgb emitted_colour(const Material& material, const WavelengthSet& set, Scratch& s);

/// The reflectance, into s.reflectance; or, where it is the same at every wavelength, its value.
std::optional<double> fill_reflectance(const Material& material, double u, double v, Scratch& s);

/// Film colours of a lamp of unit strength.
struct LampColours {
  LinearRgb whole{0.0};      ///< of all its light; where the material has a lobe
  LinearRgb reflected{0.0};  ///< of what the reflectance leaves of it
};

/// `grey` and s.reflectance: as fill_reflectance left them.
LampColours lamp_colours(const Light& light, DopplerFactor<Rest, Source> doppler, const Material& material,
                         std::optional<double> grey, const WavelengthSet& set, Scratch& s);

/// The film colour of one lamp's reflected light: Lambert's and Phong's.
inline LinearRgb reflected_colour(const LampColours& lamp, DopplerFactor<Rest, Source> doppler,
                                  double irradiance, double specular) {
  const double density = irradiance * wavelength_density_factor(doppler);
  return density * (lamp.reflected * std::numbers::inv_pi + specular * lamp.whole);
}

}  // namespace backlight
