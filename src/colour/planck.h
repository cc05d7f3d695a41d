// Constants of Planck's law.
#pragma once

namespace backlight::planck {

inline constexpr double h = 6.62607015e-34;  ///< J s, exact
inline constexpr double c = 299792458.0;     ///< m/s, exact
inline constexpr double k = 1.380649e-23;    ///< J/K, exact
inline constexpr double second_constant_nm_kelvin = 1e9 * h * c / k;

inline constexpr double d65_kelvin = 6504.0;  ///< of the blackbody that goes on with D65 outside its table

/// The logarithm of the film luminance of nm^-5 / (exp(c2 / (nm kelvin)) - 1); finite for any temperature >
/// 0.
double log_film_luminance(double kelvin);

}  // namespace backlight::planck
