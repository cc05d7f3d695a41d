// How brightness and wavelength change with the frame: docs/physics.md section 3.
//
// The only place with powers of the Doppler factor. D = DopplerFactor<To, From> is the frequency in To over
// the frequency in From of the same light ray.
#pragma once

#include "backlight/colour/rgb.h"
#include "backlight/spacetime/frame.h"

namespace backlight {

/// How the rate of arrival of photons is counted: D (what a photon counter sees), γ of the relative motion
/// (the seed paper's text: time dilation alone), or not at all.
enum class ArrivalRate { exact, dilation, off };

/// Each factor of the searchlight effect with its own switch.
struct BrightnessSwitches {
  bool photon_energy = true;                      ///< D: each photon's energy scales with its frequency
  ArrivalRate arrival_rate = ArrivalRate::exact;  ///< D, γ or 1
  bool solid_angle = true;                        ///< D²: the aberration of solid angle
  friend bool operator==(const BrightnessSwitches&, const BrightnessSwitches&) = default;
};

/// All of them off: brightness does not change with the frame.
inline constexpr BrightnessSwitches no_searchlight{false, ArrivalRate::off, false};

/// The factor on the flux that a plane wave, or a source at infinity, carries through unit area:
/// (energy)(rate) = D² when exact (docs/physics.md equation (13)). `gamma` is that of the two frames'
/// relative velocity.
template <class To, class From>
double flux_factor(DopplerFactor<To, From> d, double gamma, const BrightnessSwitches& on) {
  const double energy = on.photon_energy ? d.value : 1.0;
  const double rate = on.arrival_rate == ArrivalRate::exact      ? d.value
                      : on.arrival_rate == ArrivalRate::dilation ? gamma
                                                                 : 1.0;
  return energy * rate;
}

/// The factor F on radiance integrated over the spectrum: (energy)(rate)(solid angle) = D⁴ when exact
/// (docs/physics.md equation (7)). The same F carries a lamp's light to a surface when distances are
/// measured in the surface's frame (equation (12)).
template <class To, class From>
double radiance_factor(DopplerFactor<To, From> d, double gamma, const BrightnessSwitches& on) {
  const double solid_angle = on.solid_angle ? d.value * d.value : 1.0;
  return flux_factor(d, gamma, on) * solid_angle;
}

/// dλ_From/dλ_To: what a density per unit wavelength gains on top of F or of the flux factor when colours
/// are shifted (docs/physics.md equation (8)).
template <class To, class From>
double wavelength_density_factor(DopplerFactor<To, From> d) {
  return d.value;
}

/// The wavelength in From of what has this wavelength in To: D λ.
template <class To, class From>
double wavelength_at_origin(DopplerFactor<To, From> d, double wavelength) {
  return d.value * wavelength;
}

/// Film colour of a radiance in frame F, when no colour shift is computed.
template <class F>
struct Radiance {
  LinearRgb rgb{0.0};
};

/// The radiance as seen in frame To: L_To = F L_From.
template <class To, class From>
Radiance<To> carry(const Radiance<From>& radiance, DopplerFactor<To, From> d, double gamma,
                   const BrightnessSwitches& on) {
  return {radiance_factor(d, gamma, on) * radiance.rgb};
}

}  // namespace backlight
