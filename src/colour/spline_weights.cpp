#include "spline_weights.h"

#include <array>
#include <utility>

namespace backlight {

SplineWeights::SplineWeights(std::vector<double> nm) : nm_(std::move(nm)) {
  std::size_t cell = 0;
  for (std::size_t i = 0; i < cie::sample_count; ++i) {
    const double at = cie::first_nm + static_cast<double>(i);
    while (cell + 2 < nm_.size() && nm_[cell + 1] < at) ++cell;
    const double width = nm_[cell + 1] - nm_[cell];
    const double a = (nm_[cell + 1] - at) / width, b = 1.0 - a;
    const double sixth = width * width / 6.0;
    samples_.push_back({cell, {a, b}, {(a * a * a - a) * sixth, (b * b * b - b) * sixth}});
  }
}

// The tridiagonal equations of the natural spline for its curvatures, which are symmetric: in place.
void SplineWeights::solve_for_curvatures(std::vector<std::array<double, 3>>& right) const {
  const std::size_t n = nm_.size();
  std::vector<double> upper(n, 0.0);
  right[0] = right[n - 1] = {};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = nm_[i] - nm_[i - 1], after = nm_[i + 1] - nm_[i];
    const double pivot = 2.0 * (before + after) - before * upper[i - 1];
    upper[i] = after / pivot;
    for (std::size_t c = 0; c < 3; ++c) right[i][c] = (right[i][c] - before * right[i - 1][c]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) {
    for (std::size_t c = 0; c < 3; ++c) right[i][c] -= upper[i] * right[i + 1][c];
  }
}

std::vector<float> SplineWeights::left_out(const ObserverSamples& light, const FilmWeights& weights) const {
  std::vector<float> result(3 * cie::sample_count);
  const std::vector<double>* const channels[3] = {&weights.red, &weights.green, &weights.blue};
  for (std::size_t c = 0; c < 3; ++c) {
    // From the long end: sums of what is beyond k, of the samples and of the spline's weights.
    double exact = 0.0, exact_moment = 0.0, sum = 0.0, moment = 0.0;
    std::size_t node = nm_.size();
    for (std::size_t i = cie::sample_count; i-- > 0;) {
      const double k = cie::first_nm + static_cast<double>(i);
      for (; node > 0 && nm_[node - 1] > k; --node) {
        const double weight = (*channels[c])[node - 1];
        sum += weight;
        moment += weight * nm_[node - 1];
      }
      result[3 * i + c] = static_cast<float>((exact_moment - k * exact) - (moment - k * sum));
      exact += light[i] * rec709::film_weights[i][c];
      exact_moment += light[i] * rec709::film_weights[i][c] * k;
    }
  }
  return result;
}

FilmWeights SplineWeights::under(const ObserverSamples& light) const {
  const std::size_t n = nm_.size();
  std::vector<std::array<double, 3>> weight(n), bend(n);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Sample& s = samples_[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const double seen = light[i] * rec709::film_weights[i][c];
      weight[s.cell][c] += s.value[0] * seen;
      weight[s.cell + 1][c] += s.value[1] * seen;
      bend[s.cell][c] += s.curvature[0] * seen;
      bend[s.cell + 1][c] += s.curvature[1] * seen;
    }
  }
  // Curvatures are linear in the values: their part goes back to these by the transposed equations.
  solve_for_curvatures(bend);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = 6.0 / (nm_[i] - nm_[i - 1]), after = 6.0 / (nm_[i + 1] - nm_[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      weight[i - 1][c] += before * bend[i][c];
      weight[i][c] -= (before + after) * bend[i][c];
      weight[i + 1][c] += after * bend[i][c];
    }
  }
  FilmWeights weights;
  for (const auto& w : weight) {
    weights.red.push_back(w[0]);
    weights.green.push_back(w[1]);
    weights.blue.push_back(w[2]);
  }
  return weights;
}

}  // namespace backlight
