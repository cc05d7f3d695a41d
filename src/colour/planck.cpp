#include "planck.h"

#include <array>
#include <cmath>
#include <limits>

#include "backlight/colour/spectrum.h"
#include "cie_tables.h"

namespace backlight {

double planck::log_film_luminance(double kelvin) {
  // Logarithms of the terms, so that the sum over a body of 10 K (exp(-1700)) does not vanish.
  std::array<double, cie::sample_count> logs;
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const double nm = cie::first_nm + static_cast<double>(i);
    const double x = second_constant_nm_kelvin / (nm * kelvin);
    logs[i] = std::log(cie::observer_1931[i][1]) - 5.0 * std::log(nm) - x - std::log(-std::expm1(-x));
    largest = std::max(largest, logs[i]);
  }
  double sum = 0.0;
  for (const double term : logs) sum += std::exp(term - largest);
  constexpr double d65_sum = cie::d65_tristimulus()[1];
  return largest + std::log(sum / d65_sum);
}

double planck::log_absolute_luminance() {
  constexpr double d65_sum = cie::d65_tristimulus()[1];
  return std::log(683.0 * first_constant * d65_sum);
}

double blackbody_radiance(double kelvin, double nm) {
  const double x = planck::second_constant_nm_kelvin / (nm * kelvin);
  const double grown = std::expm1(x);
  if (std::isinf(grown)) return 0.0;
  const double nm2 = nm * nm;
  return planck::first_constant / (nm2 * nm2 * nm * grown);
}

}  // namespace backlight
