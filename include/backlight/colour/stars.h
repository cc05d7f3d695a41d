// Colours of stars.
#pragma once

namespace backlight {

/// The temperature, in kelvin, of the blackbody that has a star's colour index B-V: Ballesteros, "New
/// insights into black bodies", EPL 97 (2012) 34008, equation 14. For the B-V of stars, -0.4 to 2.0; the
/// argument is clamped to that range (21 700 K to 3 170 K), outside of which the formula is not meant to be
/// used.
double temperature_from_bv(double b_minus_v);

}  // namespace backlight
