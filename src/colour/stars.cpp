#include "backlight/colour/stars.h"

#include <algorithm>

namespace backlight {

double temperature_from_bv(double b_minus_v) {
  const double scaled = 0.92 * std::clamp(b_minus_v, -0.4, 2.0);
  return 4600.0 * (1.0 / (scaled + 1.7) + 1.0 / (scaled + 0.62));
}

}  // namespace backlight
