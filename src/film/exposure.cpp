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

// As shares of all pixels: how many may be cut at white, and how many may be shown next to white.
constexpr double most_cut = 1e-3;
constexpr double most_flattened = 1e-2;
// Reinhard's curve shows this as 0.95.
constexpr double next_to_white = 20.0;
// Drago's curve is steepest in the dark, 1 / (ln 2 lg(1 + white)), which is at most 1 from here on.
constexpr double least_white_of_drago = 26.8;

std::size_t bin_of(double luminance) {
  const double stop = std::clamp(std::log2(luminance), double(lowest_stop), double(highest_stop) - 0.001);
  return static_cast<std::size_t>((stop - lowest_stop) * bins_a_stop);
}

// By how many stops above 1 the luminance is that no more than this share of all pixels pass; 0 where it is
// below.
double stops_passed_by(double share, const LuminanceCounts& counts) {
  double low = 0.0;
  double high = highest_stop;
  if (counts.share_above(1.0) <= share) return 0.0;
  while (high - low > 1.0 / bins_a_stop) {
    const double middle = 0.5 * (low + high);
    (counts.share_above(std::exp2(middle)) > share ? low : high) = middle;
  }
  return high;
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

double LuminanceCounts::share_above(double luminance) const {
  if (pixels_ == 0) return 0.0;
  std::uint64_t above = 0;
  for (std::size_t bin = bin_of(luminance) + 1; bin < counts_.size(); ++bin) above += counts_[bin];
  return double(above) / double(pixels_);
}

double automatic_exposure(const LuminanceCounts& counts, double key) {
  const double average = counts.log_average();
  return average > 0.0 ? std::log2(key / average) : 0.0;
}

DisplayTransform automatic_transform(const LuminanceCounts& counts) {
  if (counts.share_beyond_white() <= most_cut || counts.greatest() <= 0.0) return {};
  const double darker = stops_passed_by(0.5, counts);
  const double exposure = std::exp2(-darker);
  // At least 1: a saturated colour may have a channel beyond white while its luminance is below.
  const double white =
      std::max(1.0, exposure * std::min(counts.greatest(), std::exp2(stops_passed_by(most_cut, counts))));
  const bool wide =
      white >= least_white_of_drago && counts.share_above(next_to_white / exposure) > most_flattened;
  return {0.0 - darker, wide ? ToneCurve::drago : ToneCurve::reinhard, white};
}

bool DisplayChoice::is_automatic() const {
  const bool drago = tone == ToneCurve::drago;
  return !tone || automatic_exposure || (drago && (!exposure_stops || !white));
}

DisplayTransform DisplayChoice::transform(const LuminanceCounts& counts) const {
  DisplayTransform chosen;
  if (!tone) {
    chosen = automatic_transform(counts);
    if (automatic_exposure && chosen.tone == ToneCurve::none)
      chosen.exposure_stops = backlight::automatic_exposure(counts);
    chosen.exposure_stops += exposure_stops.value_or(0.0);
  } else {
    chosen.tone = *tone;
    const bool drago = *tone == ToneCurve::drago;
    if (automatic_exposure) {
      chosen.exposure_stops = backlight::automatic_exposure(counts, drago ? 1.0 : 0.18);
    } else if (drago && !exposure_stops) {
      chosen.exposure_stops = std::min(0.0, backlight::automatic_exposure(counts, 1.0));
    } else {
      chosen.exposure_stops = exposure_stops.value_or(0.0);
    }
    const double greatest = counts.greatest() * std::exp2(chosen.exposure_stops);
    if (drago && greatest > 0.0) chosen.white = greatest;
  }
  chosen.white = white.value_or(chosen.white);
  return chosen;
}

}  // namespace backlight
