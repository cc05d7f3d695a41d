// From a light at the observer's 471 samples to the weights of a reflectance known at a few wavelengths.
#pragma once

#include <array>
#include <vector>

#include "backlight/colour/spectral_kernels.h"
#include "rec709.h"

namespace backlight {

/// The light at each of the observer's samples, 360 to 830 nm.
using ObserverSamples = std::array<double, cie::sample_count>;

/// Red, green, blue and 0 of each of the observer's samples, to be taken two or four at a time.
struct WeightLanes {
  double of[cie::sample_count][4]{};
};

constexpr WeightLanes make_film_weight_lanes() {
  WeightLanes weights;
  for (std::size_t i = 0; i < cie::sample_count; ++i) {
    for (std::size_t c = 0; c < 3; ++c) weights.of[i][c] = rec709::film_weights[i][c];
  }
  return weights;
}

inline constexpr WeightLanes film_weight_lanes = make_film_weight_lanes();

/// The natural cubic spline through values at given wavelengths, read at the observer's samples: what each
/// value adds to the film under a light, docs/colour.md equation (c1).
class SplineWeights {
 public:
  /// At least 4 wavelengths, ascending from 360 to 830 nm.
  explicit SplineWeights(std::vector<double> nm);

  /// weights[c][m]: what a reflectance 1 at wavelength m alone adds to channel c. `left_out`, if not null: by
  /// how much these weights fall short of the light's sum over max(0, λ - k), for k = 360, 361, ... 830 nm:
  /// red, green and blue of each.
  void fill(const ObserverSamples& light, double* const (&weights)[3], float* left_out) const;

 private:
  std::vector<double> nm_;
  std::vector<SplineForm::Sample> samples_;
  std::vector<SplineForm::Node> nodes_;
};

}  // namespace backlight
