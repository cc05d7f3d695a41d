// Film colours of spectra with points and lines of their own, whatever their width: docs/colour.md, "Tables
// and lines".
#pragma once

#include <span>
#include <vector>

#include "backlight/colour/spectrum.h"

namespace backlight {

/// Wavelengths of the camera, and what a reflectance of 1 at each alone adds to the film under a light.
struct FilmQuadrature {
  std::vector<double> nm;
  std::vector<LinearRgb> weight;
};

/// The film colour ∫ w(λ) S(shift λ) ρ(reflectance_shift λ) dλ of docs/physics.md equation (13a): w the
/// observer's table joined by straight lines, S the `light`, ρ the `reflectance` (null: 1). By Gauss's rule
/// between the knots of all three together, so exact for tables, however narrow; a line counts with the
/// observer's value where it arrives. A blackbody's is scaled to the luminance of the CIE's sum over 1 nm, by
/// which its colour is defined. Shifts > 0. Cost: in proportion to the knots that the visible range holds
/// where the light is not zero.
LinearRgb integrate_film(const Spectrum& light, double shift, const Spectrum* reflectance = nullptr,
                         double reflectance_shift = 1.0);

/// What takes a share of the light on its way: a reflectance or a transmittance, and at how many times the
/// camera's wavelengths.
struct Filter {
  const Spectrum* spectrum;
  double shift;
  double power = 1.0;  ///< of the share
};

/// The same under the product of several.
LinearRgb integrate_film(const Spectrum& light, double shift, std::span<const Filter> filters);

/// The same as a rule for any smooth reflectance at rest.
FilmQuadrature film_quadrature(const Spectrum& light);

}  // namespace backlight
