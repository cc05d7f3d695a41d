// Planck's law in the forms that neither overflow nor lose digits.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace backlight::planck {

inline constexpr double h = 6.62607015e-34;  ///< J s, exact
inline constexpr double c = 299792458.0;     ///< m/s, exact
inline constexpr double k = 1.380649e-23;    ///< J/K, exact
inline constexpr double second_constant_nm_kelvin = 1e9 * h * c / k;

/// nm^-5 / (exp(c2 / (nm kelvin)) - 1), divided by exp(log_scale). At most the largest double.
inline double relative_radiance(double kelvin, double nm, double log_scale) {
  const double x = second_constant_nm_kelvin / (nm * kelvin);
  const double boltzmann = std::exp(-x - log_scale);
  if (boltzmann == 0.0 || x == 0.0) return 0.0;  // the value is below the smallest double
  const double nm2 = nm * nm;
  const double value = boltzmann / (nm2 * nm2 * nm * -std::expm1(-x));
  return std::min(value, std::numeric_limits<double>::max());
}

/// The logarithm of the film luminance of `relative_radiance` with log_scale 0; finite for any temperature >
/// 0.
double log_film_luminance(double kelvin);

}  // namespace backlight::planck
