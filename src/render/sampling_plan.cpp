// From a tolerance to the law by which pixels get their samples.
#include <algorithm>
#include <cmath>

#include "backlight/film/display.h"
#include "backlight/render/adaptive_sampling.h"
#include "backlight/scene/scene.h"

namespace backlight {
namespace {

constexpr int block = 4;               // edge of a block of pixels that is looked at
constexpr int pilot_share = 16;        // one pixel of so many
constexpr double least_blocks = 24.0;  // of small pictures more: fewer would be too few to judge by
constexpr int most_blocks = 128;
// Wavelengths have a share in the error too, and the look at blocks is only that.
constexpr double sampling_share = 0.9;
// No pixel is to be further off than that many tolerances: in a picture that is nearly empty, all of the
// error would else go into the little that there is.
constexpr double most_of_a_pixel = 3.0;

constexpr std::size_t most_small_things = 256;

// What a variance (on the scale of shown_value()) adds to the square of the image's error: as many pixels' as
// `weight` says, of all the image's.
struct Share {
  double variance = 0.0;
  double weight = 0.0;
};

double whole_power(double samples) {
  return std::exp2(std::ceil(std::log2(std::max(1.0, samples))));
}

double error_squared(const std::vector<Share>& shares, const SamplingLaw& law) {
  double sum = 0.0;
  for (const Share& share : shares) {
    const double n = std::min(whole_power(law.samples_for(share.variance)), double(most_adaptive_samples));
    sum += share.weight * share.variance * std::pow(n, -1.5);
  }
  return sum;
}

// The greatest gain at which the error is no more than asked for.
double greatest_gain(const std::vector<Share>& shares, double target, SamplingLaw law) {
  double low = -60.0, high = 20.0;  // powers of two
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    law.gain = std::exp2(middle);
    (error_squared(shares, law) > target * target ? high : low) = middle;
  }
  return std::exp2(low);
}

// The blocks' upper left pixels: one in each cell of a grid over the picture, anywhere in it.
std::vector<TilePixel> block_corners(const PixelBox& picture, const SampleKey& key) {
  const double pixels = double(picture.width()) * picture.height();
  const double wanted = std::clamp(pixels / (pilot_share * block * block), least_blocks, double(most_blocks));
  const double edge = std::sqrt(pixels / wanted);
  const int columns = std::max(1, static_cast<int>(std::lround(picture.width() / edge)));
  const int rows = std::max(1, static_cast<int>(std::lround(wanted / columns)));
  std::vector<TilePixel> corners;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const ImagePoint place = unit_sample({key.seed, key.image, column, row, 1}, 0);
      corners.push_back({picture.x0 + static_cast<int>((column + place.x) / columns * picture.width()),
                         picture.y0 + static_cast<int>((row + place.y) / rows * picture.height())});
    }
  }
  return corners;
}

void look_at_blocks(const SamplingPlan& plan, const TracePoints& trace, std::vector<Share>& shares) {
  FirstLook look;
  const PixelBox& picture = plan.picture;
  for (const TilePixel& corner : block_corners(picture, plan.key)) {
    const PixelBox inner{corner.x, corner.y, std::min(picture.x1, corner.x + block),
                         std::min(picture.y1, corner.y + block)};
    const PixelBox outer{std::max(picture.x0, inner.x0 - 1), std::max(picture.y0, inner.y0 - 1),
                         std::min(picture.x1, inner.x1 + 1), std::min(picture.y1, inner.y1 + 1)};
    look.take(outer, plan.key, plan.first_count, trace);
    for (int y = inner.y0; y < inner.y1; ++y) {
      for (int x = inner.x0; x < inner.x1; ++x) {
        const Moments& seen = look.of(x, y);
        const Vec3 variance = variance_of(seen, look.prior(x, y));
        const double shown = shown_variance(variance, seen.mean, std::pow(seen.count, -0.75));
        if (std::isfinite(shown)) shares.push_back({shown, 0.0});
      }
    }
  }
  for (Share& share : shares) share.weight = 1.0 / double(shares.size());
}

// Of each a ray at it and one at the pixel.
void look_at(std::span<const SmallThing> small, const SamplingPlan& plan, const TracePoints& trace,
             std::vector<Share>& shares) {
  const std::size_t step = small.size() / most_small_things + 1;
  std::vector<ImagePoint> points;
  for (std::size_t i = 0; i < small.size(); i += step) {
    const SmallThing& thing = small[i];
    const ImagePoint place = unit_sample({plan.key.seed, plan.key.image, thing.x, thing.y}, 0);
    points.push_back(thing.centre);
    points.push_back({thing.x + place.x, thing.y + place.y});
  }
  std::vector<PixelSample> seen;
  if (!points.empty()) trace(points, seen);
  const double pixels = double(plan.picture.width()) * plan.picture.height();
  for (std::size_t i = 0; i < seen.size(); i += 2) {
    const SmallThing& thing = small[i / 2 * step];
    const double area = (thing.x1 - thing.x0) * (thing.y1 - thing.y0);
    const Vec3 off = area * (seen[i].colour - seen[i + 1].colour);
    const double shown = shown_variance(disc_variance * off * off, seen[i + 1].colour + off, 0.25);
    if (std::isfinite(shown)) shares.push_back({shown, double(step) / pixels});
  }
}

}  // namespace

double SamplingLaw::samples_for(double variance) const {
  return std::max(std::sqrt(variance / gain), std::pow(variance / (most * most), 2.0 / 3.0));
}

SamplingPlan make_plan(double tolerance, const PixelBox& picture, const SampleKey& key,
                       std::span<const SmallThing> small, const TracePoints& trace) {
  SamplingPlan plan{picture, key, tolerance < 0.02 ? 4 : 2, {1.0, most_of_a_pixel * tolerance}};
  std::vector<Share> shares;
  look_at_blocks(plan, trace, shares);
  look_at(small, plan, trace, shares);
  plan.law.gain = greatest_gain(shares, sampling_share * tolerance, plan.law);
  return plan;
}

}  // namespace backlight
