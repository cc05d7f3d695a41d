#include "backlight/render/adaptive_sampling.h"

#include <algorithm>
#include <cmath>

#include "backlight/film/display.h"

namespace backlight {
namespace {

// So many samples to a cell of the grid on average: with fewer, too many cells have only one.
constexpr double samples_per_cell = 3.0;

// Enough to find what fills 1/n of a pixel, an edge of full contrast would then be off by the tolerance: but
// edges go on into the neighbours, and a quarter of that finds them there.
std::size_t first_samples(double target) {
  return static_cast<std::size_t>(std::clamp(std::ceil(0.02 / target), 2.0, 16.0));
}

// To whole fours.
std::size_t rounded(double samples) {
  return std::min(std::size_t{most_adaptive_samples}, static_cast<std::size_t>(std::ceil(samples / 4.0)) * 4);
}

Vec3 shown(const Vec3& film) {
  return {shown_value(film.r), shown_value(film.g), shown_value(film.b)};
}

double greatest(const Vec3& v) {
  return std::max({v.r, v.g, v.b});
}

PixelEstimate mean_of(const std::vector<PixelSample>& samples) {
  PixelEstimate estimate;
  estimate.samples = static_cast<int>(samples.size());
  int covered = 0;
  for (const PixelSample& sample : samples) {
    estimate.colour += sample.colour;
    if (sample.covered) ++covered;
  }
  estimate.colour /= double(estimate.samples);
  estimate.coverage = double(covered) / estimate.samples;
  return estimate;
}

struct Cell {
  int count = 0;
  Vec3 mean{0.0};
  Vec3 squares{0.0};  // of the distances from the mean

  void add(const Vec3& value) {  // Welford 1962
    ++count;
    const Vec3 from_old = value - mean;
    mean += from_old / double(count);
    squares += from_old * (value - mean);
  }
};

}  // namespace

Vec3 standard_error(const std::vector<PixelSample>& samples) {
  const double n = static_cast<double>(samples.size());
  const int edge = std::max(1, static_cast<int>(std::sqrt(n / samples_per_cell)));
  std::vector<Cell> cells(static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge));
  for (const PixelSample& sample : samples) {
    const int column = std::min(edge - 1, static_cast<int>(sample.x * edge));
    const int row = std::min(edge - 1, static_cast<int>(sample.y * edge));
    cells[static_cast<std::size_t>(row * edge + column)].add(sample.colour);
  }
  Vec3 variance{0.0};  // of the sum: a cell adds its count times its own variance
  for (const Cell& cell : cells) {
    if (cell.count > 1) variance += cell.squares * (double(cell.count) / double(cell.count - 1));
  }
  return {std::sqrt(variance.r) / n, std::sqrt(variance.g) / n, std::sqrt(variance.b) / n};
}

AdaptiveSampler::AdaptiveSampler(double target, const PixelBox& picture)
    : target_(target), picture_(picture), first_count_(first_samples(target)) {}

bool AdaptiveSampler::tile(const PixelBox& tile, std::span<const TilePixel> wanted,
                           const TraceSamples& trace) {
  estimates_.clear();
  if (!look(tile, trace)) return false;
  std::vector<Busy> busy;
  for (const TilePixel& pixel : wanted) {
    const std::vector<PixelSample>& samples = first_[looked(pixel.x, pixel.y)];
    estimates_.push_back(mean_of(samples));
    const double difference = contrast(pixel, samples);
    // Half of what an edge of this contrast can hide from the samples is what it does on average.
    if (difference <= 2.0 * target_) continue;
    // A neighbour shows what these samples may all have missed.
    const double least = std::clamp(std::ceil(difference / (4.0 * target_)), 1.0, 64.0);
    busy.push_back({estimates_.size() - 1, rounded(least), pixel, samples});
    busy.back().wanted = std::max(busy.back().wanted, samples.size());
  }
  return refine(busy, trace);
}

std::size_t AdaptiveSampler::looked(int x, int y) const {
  return static_cast<std::size_t>(y - box_.y0) * static_cast<std::size_t>(box_.width()) +
         static_cast<std::size_t>(x - box_.x0);
}

bool AdaptiveSampler::look(const PixelBox& tile, const TraceSamples& trace) {
  box_ = {std::max(picture_.x0, tile.x0 - 1), std::max(picture_.y0, tile.y0 - 1),
          std::min(picture_.x1, tile.x1 + 1), std::min(picture_.y1, tile.y1 + 1)};
  pixels_.clear();
  for (int y = box_.y0; y < box_.y1; ++y) {
    for (int x = box_.x0; x < box_.x1; ++x) pixels_.push_back({x, y});
  }
  first_.resize(pixels_.size());
  for (std::vector<PixelSample>& samples : first_) samples.clear();
  for (std::size_t i = 0; i < first_count_; ++i) {
    if (!trace(pixels_, static_cast<int>(i), together_)) return false;
    for (std::size_t k = 0; k < pixels_.size(); ++k) first_[k].push_back(together_[k]);
  }
  shown_.clear();
  for (const std::vector<PixelSample>& samples : first_) shown_.push_back(shown(mean_of(samples).colour));
  return true;
}

// The largest difference of a pixel from its neighbours, or between its own samples.
double AdaptiveSampler::contrast(const TilePixel& pixel, const std::vector<PixelSample>& samples) const {
  const Vec3& own = shown_[looked(pixel.x, pixel.y)];
  double largest = 0.0;
  for (int j = std::max(box_.y0, pixel.y - 1); j < std::min(box_.y1, pixel.y + 2); ++j) {
    for (int i = std::max(box_.x0, pixel.x - 1); i < std::min(box_.x1, pixel.x + 2); ++i) {
      largest = std::max(largest, greatest(glm::abs(shown_[looked(i, j)] - own)));
    }
  }
  Vec3 least = samples.front().colour, most = least;
  for (const PixelSample& sample : samples) {
    least = glm::min(least, sample.colour);
    most = glm::max(most, sample.colour);
  }
  return least == most ? largest : std::max(largest, greatest(shown(most) - shown(least)));
}

// One sample of all that want one after the other: coherent rays, and the same samples as pixel by pixel.
bool AdaptiveSampler::refine(std::vector<Busy>& busy, const TraceSamples& trace) {
  const auto settle = [this](Busy& one) { return one.samples.size() >= one.wanted && is_enough(one); };
  std::erase_if(busy, settle);
  for (std::size_t index = first_count_; !busy.empty(); ++index) {
    pixels_.clear();
    for (const Busy& one : busy) pixels_.push_back(one.pixel);
    if (!trace(pixels_, static_cast<int>(index), together_)) return false;
    for (std::size_t k = 0; k < busy.size(); ++k) busy[k].samples.push_back(together_[k]);
    std::erase_if(busy, settle);
  }
  return true;
}

// Whether a pixel has the samples it needs; if not, how many it wants.
bool AdaptiveSampler::is_enough(Busy& busy) {
  PixelEstimate& estimate = estimates_[busy.place];
  estimate = mean_of(busy.samples);
  const double error = error_of(busy.samples);
  if (!(error > target_)) return true;  // of a NaN, more samples make no number
  estimate.at_limit = busy.samples.size() >= most_adaptive_samples;
  if (estimate.at_limit) return true;
  // As many as an edge needs, whose error falls with n^(-3/4); but not so many that a first estimate could
  // be far off.
  const double n = static_cast<double>(busy.samples.size());
  busy.wanted = rounded(std::clamp(n * std::pow(error / target_, 4.0 / 3.0), n + 4.0, 4.0 * n + 4.0));
  return false;
}

double AdaptiveSampler::error_of(const std::vector<PixelSample>& samples) const {
  const Vec3 error = standard_error(samples);
  const Vec3 mean = mean_of(samples).colour;
  // The scale is steeper on the dark side.
  return greatest(shown(mean) - shown(mean - error));
}

}  // namespace backlight
