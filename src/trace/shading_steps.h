// Steps of shading that one ray and a sheet of rays have in common.
#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include "backlight/scene/material_in_time.h"
#include "backlight/trace/shading.h"

namespace backlight {

/// Which of a checker's two colours, by the parity of the square in texture coordinates.
int checker_slot(const Checker& checker, double u, double v);

LinearRgb texture_reflectance(const Material& material, double u, double v);

/// Whether what the material reflects is another at each point: a texture's, or one that changes in time.
inline bool reflects_by_point(const Material& material) {
  return material.texture != nullptr || (material.in_time && material.in_time->reflectance);
}

/// That of a point, at the matter's own time `t` in scene seconds; components in [0, 1], or NaN.
LinearRgb point_reflectance(const Material& material, double u, double v, double t);

/// Phong's lobe, normalised so that `specular` is the share of the light that it reflects at normal incidence
/// (Lafortune & Willems 1994): k (n+2)/2π cosⁿα.
double specular_brdf(const Lobe& lobe, const Vec3& normal, const Vec3& to_camera, const Vec3& to_light,
                     double cosine);

/// Strength of a lamp at its own time `own_time` (times c); a formula below zero means that the lamp is off.
double strength_at(const Light& light, double own_time, double c);

// For shifted colours, docs/physics.md equation (13a).

/// What follows is at D times the film's wavelengths.
inline void shift_by(DopplerFactor<Camera, Rest> doppler, Scratch& s) {
  s.shift = doppler.value;
  s.shifted = 0;
}

/// Those, for what is not looked up by D alone.
const double* shifted_wavelengths(const WavelengthSet& set, Scratch& s);

/// The film colour of an emission seen so.
LinearRgb shifted_colour(const SeenSpectrum& emission, Scratch& s);

/// The film colour of light that is D65 times a reflectance, of the colour `rgb` >= 0 at rest, seen so.
LinearRgb shifted_rgb(const ShadingContext& context, const LinearRgb& rgb, Scratch& s);

/// The film colour of a surface's own emission at its own time `t` in scene seconds; `material`: its index.
LinearRgb emitted_colour(const ShadingContext& context, int material, double t, Scratch& s);

/// What a point reflects.
struct Reflectance {
  SeenSpectrum seen;
  std::optional<double> grey;  ///< its value, where it is the same at every wavelength

  /// It is not of this point alone: what it makes of lamps is found in Scratch::reflected.
  [[nodiscard]] bool is_looked_up() const { return seen.number != 0; }
};

/// The reflectance of a point at its own time `t` in scene seconds. Of a texture, or where it depends on t,
/// it stands in `texel`.
SeenSpectrum seen_reflectance(const ShadingContext& context, int material, double u, double v, double t,
                              Spectrum& texel);

/// The same, and sampled in s.reflectance if it is of this point alone.
Reflectance fill_reflectance(const SeenSpectrum& seen, Scratch& s);

/// Film colours of a lamp of unit strength.
struct LampColours {
  LinearRgb whole{0.0};      ///< of all its light; where the material has a lobe
  LinearRgb reflected{0.0};  ///< of what the reflectance leaves of it
};

/// `reflectance` and s.reflectance: as fill_reflectance left them.
LampColours lamp_colours(const SeenSpectrum& lamp, DopplerFactor<Rest, Source> doppler, bool has_lobe,
                         const Reflectance& reflectance, Scratch& s);

/// The film colour of one lamp's reflected light: Lambert's and Phong's.
inline LinearRgb reflected_colour(const LampColours& lamp, DopplerFactor<Rest, Source> doppler,
                                  double irradiance, double specular) {
  const double density = irradiance * wavelength_density_factor(doppler);
  return density * (std::numbers::inv_pi * lamp.reflected + specular * lamp.whole);
}

}  // namespace backlight
