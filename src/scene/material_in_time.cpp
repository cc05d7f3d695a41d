#include "backlight/scene/material_in_time.h"

#include <array>
#include <cmath>
#include <limits>

#include "backlight/colour/observer.h"

namespace backlight {
namespace {

double value_at(const Expression& formula, double t) {
  return formula.evaluate(std::array{t});
}

// NaN stays, as below.
double at_least_zero(double value) {
  return value < 0.0 ? 0.0 : value;
}

double within_one(double value) {
  return value > 1.0 ? 1.0 : at_least_zero(value);
}

}  // namespace

Lobe lobe_at(const Material& material, double t) {
  if (!material.in_time || !material.in_time->lobe) return {material.specular, material.shininess};
  const LobeInTime& lobe = *material.in_time->lobe;
  return {within_one(value_at(lobe.specular, t)), at_least_zero(value_at(lobe.shininess, t))};
}

LinearRgb reflectance_at(const ReflectanceInTime& reflectance, int slot, double t) {
  const auto& formulas = reflectance.colours[static_cast<std::size_t>(slot)];
  LinearRgb rgb;
  for (int k = 0; k < 3; ++k) rgb[k] = within_one(value_at(formulas[static_cast<std::size_t>(k)], t));
  return rgb;
}

std::optional<double> level_at(const std::optional<Expression>& level, double t) {
  if (!level) return std::nullopt;
  return within_one(value_at(*level, t));
}

EmissionNow emission_at(const EmissionInTime& emission, double t) {
  EmissionNow now;
  now.strength = emission.exposure * at_least_zero(value_at(emission.strength, t));
  if (emission.temperature) {
    const double kelvin = value_at(*emission.temperature, t);
    const bool exists = std::isfinite(kelvin) && std::isfinite(now.strength);
    if (!exists) now.strength = std::numeric_limits<double>::quiet_NaN();
    if (!exists || !(kelvin > 0.0) || !(now.strength > 0.0)) {
      now.colour = exists ? LinearRgb{0.0} : LinearRgb{now.strength};
      return now;
    }
    const Spectrum body =
        emission.absolute ? Spectrum::absolute_blackbody(kelvin) : LightRows::blackbody(kelvin);
    now.body = body.scaled(now.strength);
  } else if (emission.colour) {
    LinearRgb rgb;
    for (int k = 0; k < 3; ++k)
      rgb[k] = now.strength * at_least_zero(value_at((*emission.colour)[static_cast<std::size_t>(k)], t));
    now.colour = rgb;
  }
  return now;
}

LinearRgb own_radiance(const Material& material, double t) {
  if (!material.in_time || !material.in_time->emission)
    return material.emission ? material.emission->rgb : LinearRgb{0.0};
  const EmissionNow now = emission_at(*material.in_time->emission, t);
  if (now.body) {
    static const LightRows& rows = wavelength_set(default_wavelength_count).lights();
    return rows.at(*now.body, 1.0)->film();
  }
  return now.colour ? *now.colour : now.strength * material.emission->rgb;
}

}  // namespace backlight
