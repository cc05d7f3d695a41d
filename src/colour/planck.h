// Constants of Planck's law.
#pragma once

namespace backlight::planck {

inline constexpr double h = 6.62607015e-34;  ///< J s, exact
inline constexpr double c = 299792458.0;     ///< m/s, exact
inline constexpr double k = 1.380649e-23;    ///< J/K, exact
inline constexpr double second_constant_nm_kelvin = 1e9 * h * c / k;

/// 2 h c^2, with 10^45 for the fifth power of nanometres and 10^-9 for "per nanometre": W nm^5/(m^2 sr nm).
inline constexpr double first_constant = 2.0 * h * c * c * 1e36;

inline constexpr double d65_kelvin = 6504.0;  ///< of the blackbody that goes on with D65 outside its table

/// The logarithm of the film luminance of nm^-5 / (exp(c2 / (nm kelvin)) - 1); finite for any temperature >
/// 0.
double log_film_luminance(double kelvin);

/// The logarithm of the luminance, in cd/m^2, of a body whose film luminance in the sense of
/// log_film_luminance is 1: docs/physics.md equation (9a).
double log_absolute_luminance();

/// Relative temperatures below this count as this. Colder ones have so few visible photons that a double
/// cannot tell the logarithm of their number to a unit.
inline constexpr double coldest_kelvin = 1e-9;

}  // namespace backlight::planck
