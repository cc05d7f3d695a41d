#include "spline_weights.h"

#include <algorithm>
#include <utility>

#include "backlight/base/thread_memory.h"

namespace backlight {

SplineWeights::SplineWeights(std::vector<double> nm) : nm_(std::move(nm)), nodes_(nm_.size()) {
  samples_.reserve(cie::sample_count);
  std::size_t cell = 0;
  for (std::size_t i = 0; i < cie::sample_count; ++i) {
    const double at = cie::first_nm + static_cast<double>(i);
    while (cell + 2 < nm_.size() && nm_[cell + 1] < at) ++cell;
    const double width = nm_[cell + 1] - nm_[cell];
    const double a = (nm_[cell + 1] - at) / width, b = 1.0 - a;
    const double sixth = width * width / 6.0;
    const double share[4] = {a, b, (a * a * a - a) * sixth, (b * b * b - b) * sixth};
    SplineForm::Sample& sample = samples_.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t c = 0; c < 3; ++c) sample.share[k][c] = share[k] * rec709::film_weights[i][c];
    }
    nodes_[cell].samples_end = static_cast<int>(i) + 1;
  }
  // The tridiagonal equations of the natural spline for its curvatures, which are symmetric.
  for (std::size_t i = 0; i + 1 < nm_.size(); ++i) {
    const double after = nm_[i + 1] - nm_[i];
    SplineForm::Node& node = nodes_[i];
    node.bend = 6.0 / after;
    if (i == 0) continue;
    node.samples_end = std::max(node.samples_end, nodes_[i - 1].samples_end);
    const double before = nm_[i] - nm_[i - 1];
    node.pivot = 1.0 / (2.0 * (before + after) - before * nodes_[i - 1].upper);
    node.lower = before * node.pivot;
    node.upper = after * node.pivot;
  }
}

void SplineWeights::fill(const ObserverSamples& light, double* const (&weights)[3], float* left_out) const {
  static const SpectralKernels& widest = spectral_kernels(InstructionSet::widest);
  static constinit thread_local ThreadMemory<std::vector<double>> memory;
  std::vector<double>& work = memory.get();
  if (work.size() < 8 * nm_.size()) work.resize(8 * nm_.size());
  const SplineForm form{static_cast<int>(nm_.size()), nm_.data(), samples_.data(), nodes_.data(),
                        film_weight_lanes.of};
  widest.spline_weights(form, light.data(), work.data(), weights, left_out);
}

}  // namespace backlight
