// The estimate of a pixel's error, against errors that are known.
#include "backlight/render/adaptive_sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "backlight/camera/sampling.h"

namespace backlight {
namespace {

using Function = std::function<double(double x, double y)>;

std::vector<PixelSample> samples_of(const Function& f, int pixel, int count) {
  std::vector<PixelSample> samples;
  for (int i = 0; i < count; ++i) {
    const ImagePoint point = sample_point({.x = pixel}, i, count);
    PixelSample sample;
    sample.x = point.x - pixel;
    sample.y = point.y;
    sample.colour = Vec3{f(sample.x, sample.y), 0.0, 1.0};
    samples.push_back(sample);
  }
  return samples;
}

// Root mean square over many pixels: of the error, and of its estimate.
struct Errors {
  double true_error = 0.0;
  double estimate = 0.0;
};

Errors errors(const std::function<std::pair<Function, double>(int)>& pixel, int count) {
  constexpr int pixels = 2000;
  Errors sum;
  for (int i = 0; i < pixels; ++i) {
    const auto [f, integral] = pixel(i);
    const std::vector<PixelSample> samples = samples_of(f, i, count);
    double mean = 0.0;
    for (const PixelSample& sample : samples) mean += sample.colour.r / count;
    const Vec3 estimate = standard_error(samples);
    EXPECT_EQ(estimate.b, 0.0);
    sum.true_error += (mean - integral) * (mean - integral);
    sum.estimate += estimate.r * estimate.r;
  }
  return {std::sqrt(sum.true_error / pixels), std::sqrt(sum.estimate / pixels)};
}

// A straight edge through the pixel: x + slope (y - 1/2) < place, which fills that share of it while the edge
// leaves by the top and the bottom.
std::pair<Function, double> edge(int i) {
  const double slope = 0.5 * std::sin(1.0 + i);
  const double place = 0.25 + 0.5 * (0.5 + 0.5 * std::sin(2.7 * i));
  return {[=](double x, double y) { return x + slope * (y - 0.5) < place ? 1.0 : 0.0; }, place};
}

TEST(AdaptiveSampling, TheEstimateFollowsTheErrorOfAnEdge) {
  double last = 1.0;
  for (const int count : {16, 64, 256, 1024}) {
    const Errors e = errors(edge, count);
    EXPECT_GT(e.estimate, e.true_error) << count;
    EXPECT_LT(e.estimate, 2.0 * e.true_error) << count;
    EXPECT_LT(e.true_error, last / 2.2) << "four times the samples, a third of the error: " << count;
    last = e.true_error;
  }
}

TEST(AdaptiveSampling, TheEstimateFollowsTheErrorOfNoise) {
  // Squares much smaller than the samples' distances, black and white at random.
  const auto noise = [](int i) {
    const auto square = [i](double x, double y) {
      const double h =
          std::sin(12.9898 * std::floor(331.0 * x) + 78.233 * std::floor(331.0 * y) + i) * 43758.5453;
      return h - std::floor(h) < 0.5 ? 0.0 : 1.0;
    };
    return std::pair<Function, double>{square, 0.5};
  };
  for (const int count : {16, 64, 256}) {
    const Errors e = errors(noise, count);
    EXPECT_GT(e.estimate, 0.8 * e.true_error) << count;
    EXPECT_LT(e.estimate, 1.6 * e.true_error) << count;
  }
}

TEST(AdaptiveSampling, MoreSamplesGoWhereSomethingChanges) {
  // Black on the left, white on the right: the two columns of pixels beside the edge look twice.
  AdaptiveSampler sampler(0.01, {0, 0, 8, 8});
  const auto trace = [](std::span<const TilePixel> pixels, int, std::vector<PixelSample>& samples) {
    samples.clear();
    for (const TilePixel& pixel : pixels) samples.push_back({Vec3{pixel.x < 4 ? 0.0 : 1.0}, true, 0.5, 0.5});
    return true;
  };
  std::vector<TilePixel> row;
  for (int x = 0; x < 8; ++x) row.push_back({x, 3});
  ASSERT_TRUE(sampler.tile({0, 0, 8, 8}, row, trace));
  for (int x = 0; x < 8; ++x) {
    const PixelEstimate& estimate = sampler.estimates()[static_cast<std::size_t>(x)];
    EXPECT_EQ(estimate.colour, Vec3{x < 4 ? 0.0 : 1.0});
    EXPECT_EQ(estimate.coverage, 1.0);
    EXPECT_EQ(estimate.samples > 2, x == 3 || x == 4) << x;
    EXPECT_FALSE(estimate.at_limit);
  }
}

TEST(AdaptiveSampling, GivesUpOnWhatHasNoMean) {
  AdaptiveSampler sampler(0.001, {0, 0, 1, 1});
  int calls = 0;
  const auto trace = [&](std::span<const TilePixel>, int, std::vector<PixelSample>& samples) {
    ++calls;
    samples.assign(1, {Vec3{std::nan("")}, true, 0.5, 0.5});
    return true;
  };
  ASSERT_TRUE(sampler.tile({0, 0, 1, 1}, std::vector<TilePixel>{{0, 0}}, trace));
  EXPECT_TRUE(std::isnan(sampler.estimates()[0].colour.r));
  EXPECT_LT(calls, 100);
}

TEST(AdaptiveSampling, StopsWhenToldTo) {
  AdaptiveSampler sampler(0.01, {0, 0, 1, 1});
  const auto trace = [](std::span<const TilePixel>, int, std::vector<PixelSample>&) { return false; };
  EXPECT_FALSE(sampler.tile({0, 0, 1, 1}, std::vector<TilePixel>{{0, 0}}, trace));
}

}  // namespace
}  // namespace backlight
