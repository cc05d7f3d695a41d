#include "spline_weights.h"

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

SplineWeights::Channels SplineWeights::seen(const ObserverSamples& light, std::size_t sample) {
  const double* weights = film_weight_lanes.of[sample];
  const Lanes<2> value = light[sample];
  return {value * Lanes<2>::load(weights), value * Lanes<2>::load(weights + 2)};
}

SplineWeights::Channels SplineWeights::add(const Channels& sum, double factor, const Channels& more) {
  const Lanes<2> f = factor;
  return {sum.red_green + f * more.red_green, sum.blue + f * more.blue};
}

// The tridiagonal equations of the natural spline for its curvatures, which are symmetric: in place.
void SplineWeights::solve_for_curvatures(std::vector<Channels>& right) const {
  const std::size_t n = nm_.size();
  std::vector<double> upper(n, 0.0);
  right[0] = right[n - 1] = {};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = nm_[i] - nm_[i - 1], after = nm_[i + 1] - nm_[i];
    const double pivot = 1.0 / (2.0 * (before + after) - before * upper[i - 1]);
    upper[i] = after * pivot;
    const Channels reduced = add(right[i], -before, right[i - 1]);
    right[i] = add({}, pivot, reduced);
  }
  for (std::size_t i = n - 1; i-- > 1;) right[i] = add(right[i], -upper[i], right[i + 1]);
}

FilmWeights SplineWeights::under(const ObserverSamples& light) const {
  const std::size_t n = nm_.size();
  std::vector<Channels> weight(n), bend(n);
  for (std::size_t i = 0; i < samples_.size();) {
    const std::size_t cell = samples_[i].cell;
    Channels all, value[2], curvature[2];
    for (; i < samples_.size() && samples_[i].cell == cell; ++i) {
      const Sample& s = samples_[i];
      const Channels here = seen(light, i);
      all = add(all, 1.0, here);
      value[1] = add(value[1], s.value[1], here);
      for (int end = 0; end < 2; ++end) curvature[end] = add(curvature[end], s.curvature[end], here);
    }
    value[0] = add(all, -1.0, value[1]);  // the two shares of a value make 1
    for (std::size_t end = 0; end < 2; ++end) {
      weight[cell + end] = add(weight[cell + end], 1.0, value[end]);
      bend[cell + end] = add(bend[cell + end], 1.0, curvature[end]);
    }
  }
  // Curvatures are linear in the values: their part goes back to these by the transposed equations.
  solve_for_curvatures(bend);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = 6.0 / (nm_[i] - nm_[i - 1]), after = 6.0 / (nm_[i + 1] - nm_[i]);
    weight[i - 1] = add(weight[i - 1], before, bend[i]);
    weight[i] = add(weight[i], -(before + after), bend[i]);
    weight[i + 1] = add(weight[i + 1], after, bend[i]);
  }
  FilmWeights weights;
  for (std::vector<double>* channel : {&weights.red, &weights.green, &weights.blue}) channel->reserve(n);
  for (const Channels& w : weight) {
    weights.red.push_back(w.red_green.v[0]);
    weights.green.push_back(w.red_green.v[1]);
    weights.blue.push_back(w.blue.v[0]);
  }
  return weights;
}

std::vector<float> SplineWeights::left_out(const ObserverSamples& light, const FilmWeights& weights) const {
  std::vector<float> result(3 * cie::sample_count);
  // From the long end: sums of what is beyond k, the samples' less the spline's weights, and their moments.
  Channels sum, moment;
  std::size_t node = nm_.size();
  for (std::size_t i = cie::sample_count; i-- > 0;) {
    const double k = cie::first_nm + static_cast<double>(i);
    for (; node > 0 && nm_[node - 1] > k; --node) {
      Channels w;
      w.red_green.v[0] = weights.red[node - 1];
      w.red_green.v[1] = weights.green[node - 1];
      w.blue.v[0] = weights.blue[node - 1];
      sum = add(sum, -1.0, w);
      moment = add(moment, -nm_[node - 1], w);
    }
    const Channels off = add(moment, -k, sum);
    result[3 * i] = static_cast<float>(off.red_green.v[0]);
    result[3 * i + 1] = static_cast<float>(off.red_green.v[1]);
    result[3 * i + 2] = static_cast<float>(off.blue.v[0]);
    const Channels here = seen(light, i);
    sum = add(sum, 1.0, here);
    moment = add(moment, k, here);
  }
  return result;
}

}  // namespace backlight
