#include "backlight/film/exposure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace backlight {
namespace {

constexpr int bins_a_stop = 8;
constexpr int lowest_stop = -160;  // of the smallest subnormal float and the greatest float
constexpr int highest_stop = 130;

std::size_t bin_of(double luminance) {
  const double stop = std::clamp(std::log2(luminance), double(lowest_stop), double(highest_stop) - 0.001);
  return static_cast<std::size_t>((stop - lowest_stop) * bins_a_stop);
}

}  // namespace

LuminanceCounts::LuminanceCounts()
    : counts_((highest_stop - lowest_stop) * bins_a_stop), logarithms_(counts_.size()) {}

Result<void> LuminanceCounts::add(const Image& image, std::size_t view) {
  const auto channels = colour_channels(image, view);
  if (!channels.ok()) return channels.failure();
  const auto& [r, g, b] = channels.value();
  for (std::size_t i = 0; i < image.plane(r).size(); ++i) {
    const Vec3 rgb{image.plane(r)[i], image.plane(g)[i], image.plane(b)[i]};
    const double luminance = 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b;
    ++pixels_;
    if (std::max({rgb.r, rgb.g, rgb.b}) > 1.0) ++beyond_white_;
    if (!std::isfinite(luminance) || luminance <= 0.0) continue;
    greatest_ = std::max(greatest_, luminance);
    ++counts_[bin_of(luminance)];
    logarithms_[bin_of(luminance)] += std::log(luminance);
  }
  return {};
}

double LuminanceCounts::log_average() const {
  if (greatest_ <= 0.0) return 0.0;
  std::uint64_t count = 0;
  double sum = 0.0;
  for (std::size_t bin = bin_of(greatest_ * 1e-6); bin < counts_.size(); ++bin) {
    count += counts_[bin];
    sum += logarithms_[bin];
  }
  return std::exp(sum / double(count));
}

double LuminanceCounts::share_beyond_white() const {
  return pixels_ == 0 ? 0.0 : double(beyond_white_) / double(pixels_);
}

double automatic_exposure(const LuminanceCounts& counts, double key) {
  const double average = counts.log_average();
  return average > 0.0 ? std::log2(key / average) : 0.0;
}

DisplayTransform automatic_transform(const LuminanceCounts& counts) {
  if (counts.share_beyond_white() <= 1e-3) return {};
  const double average = counts.log_average();
  if (average <= 0.0) return {};
  return {-std::log2(average), ToneCurve::drago, counts.greatest() / average};
}

}  // namespace backlight
