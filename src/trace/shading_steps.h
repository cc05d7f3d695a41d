// Steps of shading that one ray and a sheet of rays have in common.
#pragma once

#include <vector>

#include "backlight/trace/shading.h"

namespace backlight {

/// Which of a checker's two colours, by the parity of the square in texture coordinates.
int checker_slot(const Checker& checker, double u, double v);

LinearRgb texture_reflectance(const Material& material, double u, double v);

/// Strength of a lamp at its own time `own_time` (times c); a formula below zero means that the lamp is off.
double strength_at(const Light& light, double own_time, double c, std::vector<double>& variables);

/// At s.wavelengths (surface's frame): own emission into s.radiance, and the reflectance into s.reflectance.
void begin_spectrum(const Material& material, double u, double v, Scratch& s);

/// Adds the reflected light of one lamp to s.radiance.
void add_spectrum(const Light& light, DopplerFactor<Rest, Source> doppler, double irradiance, double specular,
                  Scratch& s);

}  // namespace backlight
