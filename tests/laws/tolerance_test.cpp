// The error that an image has where one is asked for, against the same scene traced far finer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "backlight/film/display.h"
#include "backlight/render/wavelength_estimate.h"
#include "rendering.h"

namespace backlight::test {
namespace {

// Edges straight and curved, shadows, a checker up to the horizon; bright and dark; with and without shifts.
std::string scene(const std::string& motion) {
  return "[camera]\nposition = [0, 1, -7]\n" + motion + R"toml(
[[light]]
position = [-4, 6, -6]
intensity = 300
[[object]]
shape = "plane"
position = [0, -1, 0]
material = { checker = { colors = [[0.8, 0.8, 0.8], [0.1, 0.02, 0.02]], size = 1 } }
[[object]]
shape = "sphere"
radius = 1
position = [-1, 0, 0]
material = { color = [0.8, 0.2, 0.1] }
[[object]]
shape = "box"
size = [1, 1, 1]
position = [1.2, 0, 1]
material = { color = [0.1, 0.3, 0.8] }
[background]
color = [0.1, 0.2, 0.4]
)toml";
}

struct Delivered {
  double rms = 0.0;     // over all pixels and channels
  double within = 0.0;  // share of the pixels of which no channel is further off than three times that
};

Delivered delivered(const Rendering& image, const Rendering& fine, double tolerance) {
  double squares = 0.0, within = 0.0;
  const double pixels = double(fine.width()) * fine.height();
  for (int y = 0; y < fine.height(); ++y) {
    for (int x = 0; x < fine.width(); ++x) {
      double worst = 0.0;
      for (int c = 0; c < 3; ++c) {
        const double off = std::abs(shown_value(image.rgb(x, y)[c]) - shown_value(fine.rgb(x, y)[c]));
        worst = std::max(worst, off);
        squares += off * off;
      }
      if (worst <= 3.0 * tolerance) within += 1.0;
    }
  }
  return {std::sqrt(squares / (3.0 * pixels)), within / pixels};
}

void expect_delivered(const std::string& text) {
  const std::string size = "film.resolution=[60, 40]";
  const Rendering fine = render_text(text, {.overrides = {size, "film.samples=900", "film.seed=7"}});
  double cost = 0.0;
  for (const double tolerance : {0.04, 0.01}) {
    const std::string asked = "film.tolerance=" + std::to_string(tolerance);
    const Rendering image = render_text(text, {.overrides = {size, asked}});
    const Delivered error = delivered(image, fine, tolerance);
    EXPECT_LE(error.rms, tolerance);
    EXPECT_GE(error.within, 0.97) << "asked for " << tolerance;
    EXPECT_GT(image.statistics.samples.mean(), cost) << "a smaller error is to take more samples";
    cost = image.statistics.samples.mean();
  }
}

TEST(Tolerance, IsMetAtRest) {
  expect_delivered(scene(""));
}

TEST(Tolerance, IsMetWhereColoursShift) {
  expect_delivered(scene("beta = [0.3, 0, 0.5]"));
}

// Glowing balls a fifth of a pixel across and less, at rest and moving, far brighter than white: against the
// mean of 32 x 32 pixels for each, in which they are balls like others.
TEST(Tolerance, IsMetBySmallBrightThings) {
  std::string text =
      "[camera]\nbeta = [0, 0.2, 0.3]\n[background]\ncolor = [0.02, 0.03, 0.05]\n"
      "[effects]\nsearchlight = \"off\"\n";
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 4; ++j) {
      text += "[[object]]\nshape = \"sphere\"\nradius = " + std::to_string(0.03 + 0.01 * i) +
              "\nposition = [" + std::to_string(2.03 * (i - 2)) + ", " + std::to_string(1.57 * j - 2.1) +
              ", 10]\nmaterial = { emission = 40, emission_color = [1, 0.9, 0.8] }\n";
      if (j % 2 == 1) text += "beta = [0.5, " + std::to_string(0.1 * i) + ", 0]\n";
    }
  }
  constexpr int width = 16, height = 12, zoom = 32;
  const std::string fine_size =
      "film.resolution=[" + std::to_string(width * zoom) + ", " + std::to_string(height * zoom) + "]";
  const Rendering fine = render_text(text, {.wavelengths = 16, .overrides = {fine_size, "film.samples=16"}});
  std::vector<Vec3> means;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      Vec3 mean{0.0};
      for (int k = 0; k < zoom * zoom; ++k)
        mean += fine.rgb(x * zoom + k % zoom, y * zoom + k / zoom) / double(zoom * zoom);
      means.push_back(mean);
    }
  }
  // What is promised is the root mean square: of one drawing of the samples' positions it may be more.
  constexpr int seeds = 6;
  for (const std::string asked : {"0.05", "0.01", "0.004"}) {
    double squares = 0.0, of_black = 0.0;
    for (int seed = 0; seed < seeds; ++seed) {
      const Rendering image =
          render_text(text, {.wavelengths = 16,
                             .overrides = {"film.resolution=[16, 12]", "film.tolerance=" + asked,
                                           "film.seed=" + std::to_string(seed)}});
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          for (int c = 0; c < 3; ++c) {
            const double exact = shown_value(means[static_cast<std::size_t>(y * width + x)][c]);
            squares += std::pow(shown_value(image.rgb(x, y)[c]) - exact, 2) / (3.0 * width * height * seeds);
            of_black += exact * exact / (3.0 * width * height * seeds);
          }
        }
      }
      EXPECT_LT(image.statistics.samples.mean(), 300.0);
      EXPECT_EQ(image.statistics.samples.at_limit, 0U);
    }
    EXPECT_GT(std::sqrt(of_black), 0.1) << "there is nothing to be found";
    EXPECT_LE(std::sqrt(squares), std::stod(asked));
  }
}

TEST(Tolerance, NumbersThatAreGivenWin) {
  const std::string moving = scene("beta = [0.3, 0, 0.5]");
  const std::vector<std::string> size = {"film.resolution=[40, 30]", "film.samples=2", "film.wavelengths=20"};
  std::vector<std::string> both = size;
  both.emplace_back("film.tolerance=0.05");
  const Rendering without = render_text(moving, {.overrides = size});
  const Rendering with = render_text(moving, {.overrides = both});
  EXPECT_TRUE(std::ranges::equal(without.image.plane(0), with.image.plane(0)));
  EXPECT_EQ(with.statistics.samples.most, 2U);
}

TEST(Tolerance, FewerWavelengthsAreEnoughForALargerError) {
  const auto count = [](const std::string& tolerance) {
    const Rendering image = render_text(
        scene("beta = [0.3, 0, 0.5]"),
        {.overrides = {"film.resolution=[40, 30]", "film.samples=1", "film.tolerance=" + tolerance}});
    return needs_within_tolerance(image.scene).wavelengths;
  };
  EXPECT_LT(count("0.1"), count("0.001"));
  EXPECT_GE(count("0.1"), 8);
}

TEST(Tolerance, CostsNothingWhereNothingChanges) {
  // What is flat takes the two first samples and no more.
  const Rendering flat = render_text(
      "[film]\nresolution = [20, 20]\ntolerance = 0.05\n[camera]\n[background]\ncolor = [0.5, 0.5, 0.5]\n");
  EXPECT_EQ(flat.statistics.samples.total, 2U * 400U);
}

}  // namespace
}  // namespace backlight::test
