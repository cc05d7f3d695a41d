// A material at one instant of its own time: docs/physics.md equation (9b).
#pragma once

#include <optional>

#include "backlight/scene/scene.h"

namespace backlight {

/// Phong's lobe.
struct Lobe {
  double specular = 0.0;
  double shininess = 50.0;
};

/// What of it is reflected by the lobe. `t`: the matter's own time in scene seconds, here and below. A
/// `specular` outside [0, 1] is its nearest end, a negative `shininess` is 0.
Lobe lobe_at(const Material& material, double t);

/// Whether the lobe reflects anything at some time.
inline bool has_lobe(const Material& material) {
  return material.specular > 0.0 || (material.in_time && material.in_time->lobe);
}

/// Red, green and blue of the square `slot` (0 without a checker), clamped to [0, 1]; a NaN stays.
LinearRgb reflectance_at(const ReflectanceInTime& reflectance, int slot, double t);

/// A level in the ultraviolet or the infrared, if there is one.
std::optional<double> level_at(const std::optional<Expression>& level, double t);

/// Own radiance, at rest to itself: that of `body`, or `colour`, or `strength` times Material::emission. A
/// negative strength, a negative component of a colour and a temperature of 0 or less are nothing; what has
/// no value is a NaN.
struct EmissionNow {
  double strength = 0.0;
  std::optional<Spectrum> body;  ///< of its whole strength
  std::optional<LinearRgb> colour;
};
EmissionNow emission_at(const EmissionInTime& emission, double t);

/// The film colour at rest of a material's own radiance.
LinearRgb own_radiance(const Material& material, double t);

}  // namespace backlight
