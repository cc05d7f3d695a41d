// From a light at the observer's 471 samples to the weights of a reflectance known at a few wavelengths.
#pragma once

#include <array>
#include <vector>

#include "backlight/base/lanes.h"
#include "rec709.h"

namespace backlight {

/// The light at each of the observer's samples, 360 to 830 nm.
using ObserverSamples = std::array<double, cie::sample_count>;

/// Red, green, blue and 0 of each of the observer's samples, to be taken two at a time.
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

/// One value a wavelength, for each of the film's channels.
struct FilmWeights {
  std::vector<double> red, green, blue;
};

/// The natural cubic spline through values at given wavelengths, read at the observer's samples: what each
/// value adds to the film under a light, docs/colour.md equation (c1).
class SplineWeights {
 public:
  /// At least 4 wavelengths, ascending from 360 to 830 nm.
  explicit SplineWeights(std::vector<double> nm);

  [[nodiscard]] FilmWeights under(const ObserverSamples& light) const;

  /// By how much these weights of that light fall short of its sum over max(0, λ - k), for k = 360, 361, ...
  /// 830 nm: red, green and blue of each.
  [[nodiscard]] std::vector<float> left_out(const ObserverSamples& light, const FilmWeights& weights) const;

 private:
  // What the values and the curvatures at both ends of a sample's cell have in the spline there.
  struct Sample {
    std::size_t cell;
    double value[2];
    double curvature[2];
  };
  /// Red and green, blue and nothing.
  struct Channels {
    Lanes<2> red_green = 0.0;
    Lanes<2> blue = 0.0;
  };
  void solve_for_curvatures(std::vector<Channels>& right) const;
  static Channels seen(const ObserverSamples& light, std::size_t sample);
  static Channels add(const Channels& sum, double factor, const Channels& more);

  std::vector<double> nm_;
  std::vector<Sample> samples_;
};

}  // namespace backlight
