#include "light_samples.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "backlight/base/lane_exponential.h"
#include "backlight/base/lane_power.h"
#include "backlight/colour/spectrum.h"
#include "planck.h"

namespace backlight {
namespace {

double logarithm_of(double x) {
  return 0.69314718055994530942 * log2_of_positive(Lanes<2>(x)).v[0];
}

LinearRgb weighted_sum(const ObserverSamples& light, const WeightLanes& weights) {
  Lanes<2> red_green = 0.0, blue = 0.0;
  for (std::size_t i = 0; i < light.size(); ++i) {
    red_green = red_green + Lanes<2>(light[i]) * Lanes<2>::load(weights.of[i]);
    blue = blue + Lanes<2>(light[i]) * Lanes<2>::load(weights.of[i] + 2);
  }
  return {red_green.v[0], red_green.v[1], blue.v[0]};
}

LinearRgb sum_over_film(const ObserverSamples& light) {
  return weighted_sum(light, film_weight_lanes);
}

ObserverSamples samples_of(const Spectrum& light, double shift) {
  ObserverSamples nm, values;
  for (std::size_t i = 0; i < nm.size(); ++i) nm[i] = shift * (cie::first_nm + static_cast<double>(i));
  light.evaluate(nm.data(), cie::sample_count, values.data());
  return values;
}

// (λ w)' by the neighbours.
constexpr WeightLanes make_moment_slopes() {
  WeightLanes slopes;
  for (std::size_t i = 1; i + 1 < cie::sample_count; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double nm = cie::first_nm + static_cast<double>(i);
      slopes.of[i][c] =
          0.5 * ((nm + 1.0) * rec709::film_weights[i + 1][c] - (nm - 1.0) * rec709::film_weights[i - 1][c]);
    }
  }
  return slopes;
}

// d/ds Σ w(λ) S(sλ) = -1/s Σ (λ w)' S(sλ), whatever teeth S has.
LinearRgb film_slope(const ObserverSamples& light, double shift) {
  static constexpr WeightLanes moment_slopes = make_moment_slopes();
  return weighted_sum(light, moment_slopes) * (-1.0 / shift);
}

// Relative to the Boltzmann factor at 830 nm, so that none vanishes, however cold the body is.
double body_reference(double kelvin) {
  return planck::second_constant_nm_kelvin / (cie::last_nm * kelvin);
}

ObserverSamples body_at(double kelvin) {
  return samples_of(Spectrum::planckian(kelvin, -body_reference(kelvin)), 1.0);
}

}  // namespace

// Each nanometre of D65's own goes to the two of the observer's samples next to where it arrives, in shares
// by its distance. At rest that is D65 itself. Its table has a joint every 5 nm; read at the observer's
// samples their shifted places would make a sum that trembles with the shift, by 1e-4.
ObserverSamples daylight_at(double shift) {
  constexpr double before = cie::first_nm - 1.0, after = cie::last_nm + 1.0;
  static const std::vector<double> own = [] {
    std::vector<double> nm(static_cast<std::size_t>(shifts.end * after) + 1), values(nm.size());
    for (std::size_t i = 0; i < nm.size(); ++i) nm[i] = std::max(1.0, static_cast<double>(i));
    Spectrum::d65().evaluate(nm.data(), static_cast<int>(nm.size()), values.data());
    return values;
  }();
  const double per_nm = 1.0 / shift;
  double shared[cie::sample_count + 3]{};  // from 359 nm on
  const auto end = static_cast<std::size_t>(shift * after);
  for (auto i = static_cast<std::size_t>(std::ceil(shift * before)); i <= end; ++i) {
    const double place = static_cast<double>(i) * per_nm - before;
    const auto sample = static_cast<std::size_t>(place);
    const double further = place - static_cast<double>(sample);
    const double light = per_nm * own[i];
    shared[sample] += (1.0 - further) * light;
    shared[sample + 1] += further * light;
  }
  ObserverSamples values;
  std::copy_n(shared + 1, values.size(), values.begin());
  return values;
}

LightRows::Row daylight_row(double shift) {
  const ObserverSamples light = daylight_at(shift);
  return {0.0, 0.0, sum_over_film(light), film_slope(light, shift)};
}

ObserverSamples normalised_body(double kelvin) {
  ObserverSamples light = body_at(kelvin);
  const double y = luminance(sum_over_film(light));
  for (double& value : light) value /= y;
  return light;
}

LightRows::Row body_row(double kelvin) {
  const ObserverSamples light = body_at(kelvin);
  // d ln B / d ln T = x / (1 - exp(-x)) = x (1 + 1 / (exp(x) - 1)), x = c2/(λT); B is λ^-5 / (exp(x) - 1)
  const double share = exponential(Lanes<2>(-body_reference(kelvin))).value().v[0];
  ObserverSamples growth;
  for (std::size_t i = 0; i < growth.size(); ++i) {
    const double nm = cie::first_nm + static_cast<double>(i);
    const double x = planck::second_constant_nm_kelvin / (nm * kelvin);
    growth[i] = light[i] * (x * (1.0 + light[i] * share * (nm * nm) * (nm * nm) * nm));
  }
  const LinearRgb film = sum_over_film(light), slope = sum_over_film(growth) / kelvin;
  const double y = luminance(film), y_slope = luminance(slope);
  LightRows::Row row;
  row.log_scale = logarithm_of(y) - body_reference(kelvin);
  row.log_slope = y_slope / y;
  row.film = film / y;
  row.film_slope = slope / y - row.film * row.log_slope;
  return row;
}

}  // namespace backlight
