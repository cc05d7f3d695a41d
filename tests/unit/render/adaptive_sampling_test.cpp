// The choice of samples, on images that are functions of the place.
#include "backlight/render/adaptive_sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "backlight/film/display.h"

namespace backlight {
namespace {

using Function = std::function<double(double x, double y)>;

constexpr PixelBox picture{0, 0, 40, 30};

TracePoints tracing(const Function& f) {
  return [f](std::span<const ImagePoint> points, std::vector<PixelSample>& samples) {
    samples.clear();
    for (const ImagePoint& p : points) samples.push_back({Vec3{f(p.x, p.y), 0.25, 1.0}, true});
    return true;
  };
}

std::vector<TilePixel> pixels_of(const PixelBox& box) {
  std::vector<TilePixel> pixels;
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) pixels.push_back({x, y});
  }
  return pixels;
}

std::vector<PixelEstimate> estimates(const Function& f, double tolerance, const PixelBox& box = picture,
                                     const std::vector<SmallThing>& small = {}) {
  const SamplingPlan plan = make_plan(tolerance, picture, {7, 1}, small, tracing(f));
  AdaptiveSampler sampler(plan);
  EXPECT_TRUE(sampler.tile(box, pixels_of(box), small, tracing(f)));
  return sampler.estimates();
}

// A dark half plane with a slanted edge, a grey disc, and a soft gradient over all.
double shapes(double x, double y) {
  const double gradient = 0.2 + 0.004 * x;
  if (std::hypot(x - 27.3, y - 12.1) < 7.7) return 0.7 + gradient;
  return x + 0.37 * y < 17.0 ? 0.05 : gradient;
}

struct Delivered {
  double rms = 0.0;
  double samples = 0.0;
};

double fine_mean(const Function& f, const TilePixel& pixel) {
  constexpr int edge = 100;
  double sum = 0.0;
  for (int j = 0; j < edge; ++j) {
    for (int i = 0; i < edge; ++i) sum += f(pixel.x + (i + 0.5) / edge, pixel.y + (j + 0.5) / edge);
  }
  return sum / (edge * edge);
}

Delivered delivered(const Function& f, const std::function<PixelEstimate(std::size_t)>& estimate) {
  Delivered result;
  const std::vector<TilePixel> pixels = pixels_of(picture);
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const PixelEstimate pixel = estimate(k);
    EXPECT_NEAR(pixel.colour.g, 0.25, 1e-12);
    EXPECT_NEAR(pixel.coverage, 1.0, 1e-12);
    const double off = shown_value(pixel.colour.r) - shown_value(fine_mean(f, pixels[k]));
    result.rms += off * off / 3.0;  // of three channels two are exact
    result.samples += pixel.samples;
  }
  result.rms = std::sqrt(result.rms / double(pixels.size()));
  result.samples /= double(pixels.size());
  return result;
}

Delivered uniform(const Function& f, int samples) {
  const std::vector<TilePixel> pixels = pixels_of(picture);
  return delivered(f, [&](std::size_t k) {
    PixelEstimate estimate{Vec3{0.0}, 1.0, samples};
    for (int i = 0; i < samples; ++i) {
      const ImagePoint p = sample_point({7, 1, pixels[k].x, pixels[k].y}, i, samples);
      estimate.colour += Vec3{f(p.x, p.y), 0.25, 1.0} / double(samples);
    }
    return estimate;
  });
}

TEST(AdaptiveSampling, DeliversTheErrorAskedForWithFewerSamplesThanUniform) {
  double cost = 0.0;
  for (const auto& [tolerance, gain] : {std::pair{0.01, 1.5}, {0.003, 2.0}, {0.001, 2.0}}) {
    const auto found = estimates(shapes, tolerance);
    const Delivered adaptive = delivered(shapes, [&](std::size_t k) { return found[k]; });
    EXPECT_LE(adaptive.rms, tolerance);
    EXPECT_GT(adaptive.rms, 0.25 * tolerance) << "more samples than it takes";
    EXPECT_GT(adaptive.samples, cost);
    cost = adaptive.samples;
    // As many uniform ones, and then as many more, are still worse.
    EXPECT_GT(uniform(shapes, static_cast<int>(gain * adaptive.samples)).rms, adaptive.rms) << tolerance;
  }
}

TEST(AdaptiveSampling, ThePixelsDoNotDependOnTheTile) {
  const std::vector<SmallThing> small = {{5, 4, 0.2, 0.3, 0.6, 0.7, {5.4, 4.5}}};
  const auto f = [](double x, double y) { return std::hypot(x - 5.4, y - 4.5) < 0.2 ? 9.0 : shapes(x, y); };
  const auto whole = estimates(f, 0.01, picture, small);
  for (const PixelBox box : {PixelBox{4, 3, 12, 9}, PixelBox{5, 4, 6, 5}, PixelBox{33, 0, 40, 30}}) {
    const auto part = estimates(f, 0.01, box, small);
    const auto pixels = pixels_of(box);
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      const PixelEstimate& same = whole[static_cast<std::size_t>(pixels[k].y * picture.x1 + pixels[k].x)];
      EXPECT_EQ(part[k].colour, same.colour);
      EXPECT_EQ(part[k].samples, same.samples);
    }
  }
}

// Discs a tenth of a pixel across, far brighter than white, where no first sample finds most of them.
TEST(AdaptiveSampling, FindsWhatIsSmallerThanAPixel) {
  constexpr double radius = 0.05, brightness = 300.0, ground = 0.1;
  std::vector<ImagePoint> discs;
  std::vector<SmallThing> small;
  for (int y = 1; y < 30; y += 3) {
    for (int x = 1; x < 40; x += 3) {
      const ImagePoint at{0.1 + 0.8 * std::fmod(0.37 * x, 1.0),
                          0.1 + 0.8 * std::fmod(0.73 * y + 0.1 * x, 1.0)};
      discs.push_back({x + at.x, y + at.y});
      small.push_back(
          {x, y, at.x - radius, at.y - radius, at.x + radius, at.y + radius, {x + at.x, y + at.y}});
    }
  }
  const auto f = [&](double x, double y) {
    for (const ImagePoint& disc : discs) {
      if (std::hypot(x - disc.x, y - disc.y) < radius) return brightness;
    }
    return ground;
  };
  const double exact = ground + (brightness - ground) * std::numbers::pi * radius * radius;
  const auto rms = [&](const std::vector<PixelEstimate>& found) {
    double squares = 0.0;
    for (const SmallThing& thing : small) {
      const PixelEstimate& pixel = found[static_cast<std::size_t>(thing.y * 40 + thing.x)];
      EXPECT_FALSE(pixel.at_limit);
      const double off = shown_value(pixel.colour.r) - shown_value(exact);
      squares += off * off / 3.0;
    }
    return std::sqrt(squares / double(small.size()));
  };
  for (const double tolerance : {0.05, 0.01, 0.003}) {
    EXPECT_LT(rms(estimates(f, tolerance, picture, small)), 3.0 * tolerance) << tolerance;
  }
  double samples = 0.0;  // even samples would need some 30,000 for the third of them
  for (const PixelEstimate& pixel : estimates(f, 0.01, picture, small)) samples += pixel.samples / 1200.0;
  EXPECT_LT(samples, 60.0);
  EXPECT_GT(rms(estimates(f, 0.05)), 0.5) << "the test is of something that is found without";
}

TEST(AdaptiveSampling, SpendsNothingOnSmallThingsThatDoNotMatter) {
  const std::vector<SmallThing> hidden = {{20, 15, 0.3, 0.3, 0.5, 0.5, {20.4, 15.4}}};
  const auto flat = [](double, double) { return 0.3; };
  for (const PixelEstimate& pixel : estimates(flat, 0.01, picture, hidden)) {
    EXPECT_EQ(pixel.samples, 4);
    EXPECT_EQ(pixel.colour.r, 0.3);
  }
}

TEST(AdaptiveSampling, ManySmallThingsOfAPixelAreNoBias) {
  std::vector<SmallThing> small;
  for (int i = 0; i < 30; ++i) {
    const double x = 0.5 + 0.4 * std::sin(i * 2.1), y = 0.5 + 0.4 * std::sin(i * 3.7 + 1.0);
    small.push_back({9, 9, x - 0.03, y - 0.03, x + 0.03, y + 0.03, {9 + x, 9 + y}});
  }
  const auto f = [&](double x, double y) {
    for (const SmallThing& s : small) {
      if (std::hypot(x - s.centre.x, y - s.centre.y) < 0.03) return 4.0;
    }
    return 0.2;
  };
  const PixelEstimate pixel = estimates(f, 0.005, picture, small)[9 * 40 + 9];
  EXPECT_NEAR(shown_value(pixel.colour.r), shown_value(fine_mean(f, {9, 9})), 0.04);
}

TEST(AdaptiveSampling, TheLawTellsNumbersAndComparesAlike) {
  const SamplingLaw law{1e-4, 0.05};
  for (const double variance : {1e-6, 1e-4, 0.01, 1.0, 100.0}) {
    const double n = law.samples_for(variance);
    EXPECT_TRUE(law.wants_more(variance, 0.999 * n));
    EXPECT_FALSE(law.wants_more(variance, 1.001 * n));
  }
  EXPECT_FALSE(law.wants_more(std::nan(""), 1.0));
}

TEST(AdaptiveSampling, VariancesCountAsTheyAreSeen) {
  // 1 + 0.4396 ln v beyond white; 12.92 v in the dark.
  EXPECT_NEAR(shown_variance({0.01, 0.01, 0.01}, Vec3{50.0}, 0.1), 0.01 * std::pow(0.4396 / 50.0, 2), 1e-8);
  EXPECT_NEAR(shown_variance({1e-8, 0.0, 0.0}, Vec3{0.001}, 0.1), 1e-8 * 12.92 * 12.92 / 3.0, 1e-12);
  EXPECT_EQ(shown_variance(Vec3{0.0}, Vec3{0.5}, 1.0), 0.0);
}

TEST(AdaptiveSampling, GivesUpOnWhatHasNoMean) {
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    int calls = 0;
    const Function f = [&](double, double) {
      ++calls;
      return value;
    };
    const SamplingPlan plan = make_plan(0.001, picture, {7, 1}, {}, tracing(f));
    AdaptiveSampler sampler(plan);
    calls = 0;
    ASSERT_TRUE(sampler.tile({0, 0, 1, 1}, pixels_of({0, 0, 1, 1}), {}, tracing(f)));
    EXPECT_FALSE(std::isfinite(sampler.estimates()[0].colour.r));
    EXPECT_LT(calls, 100);
  }
}

TEST(AdaptiveSampling, StopsWhenToldTo) {
  const SamplingPlan plan = make_plan(0.01, picture, {7, 1}, {}, tracing(shapes));
  for (int calls_before = 0; calls_before < 3; ++calls_before) {
    AdaptiveSampler sampler(plan);
    int calls = 0;
    const auto trace = [&](std::span<const ImagePoint> points, std::vector<PixelSample>& samples) {
      return calls++ < calls_before && tracing(shapes)(points, samples);
    };
    EXPECT_FALSE(sampler.tile({0, 0, 20, 20}, pixels_of({0, 0, 20, 20}), {}, trace));
  }
}

}  // namespace
}  // namespace backlight
