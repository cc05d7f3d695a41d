// The same bits for any number of threads and any crop.
#include <gtest/gtest.h>

#include "rendering.h"
#include "same_bits.h"

namespace backlight::test {
namespace {

// Everything that could tempt a renderer into an order: samples, stars, regions, flicker, many frames.
std::string scene(const std::string& eyes = "") {
  std::string s = std::string(R"toml(
[film]
resolution = [75, 53]
samples = 3
aovs = ["Z", "doppler", "emissionTime", "properTime", "P", "N", "objectId"]
[camera]
position = [0, 1, -7]
direction = [0, -0.1, 1]
beta = [0.2, 0, 0.4]
)toml") + eyes + R"toml([background]
color = [0.1, 0.2, 0.4]
stars = { count = 3000, seed = 4 }
[[light]]
position = [-4, 6, -6]
intensity = "300 + 100*sin(3*t)"
[[effects.region]]
rect = [0.4, 0.3, 0.8, 0.9]
doppler = false
searchlight = "off"
[[object]]
shape = "plane"
position = [0, -1, 0]
material = { checker = { colors = [[0.8, 0.8, 0.8], [0.3, 0.1, 0.1]], size = 1 } }
)toml";
  s += "[[object]]\nshape = \"torus\"\nmajor = 1\nminor = 0.3\nposition = [1, 1, 3]\ngamma = 1e5\nalong = "
       "[0.2, 0, 1]\n";
  for (int i = 0; i < 12; ++i) {
    s += "[[object]]\nshape = \"sphere\"\nradius = 0.5\nposition = [" + std::to_string(i % 4 * 1.5 - 2) +
         ", 0, " + std::to_string(i / 4 * 2) + "]\nbeta = [" + std::to_string(0.05 * i) + ", 0, 0.3]\n";
  }
  return s;
}

TEST(SameBits, ForAnyNumberOfThreads) {
  const Rendering one = render_text(scene(), {.threads = 1});
  for (const int threads : {2, 3, 8})
    expect_same_bits(one.image, render_text(scene(), {.threads = threads}).image);
}

TEST(SameBits, ForStereoPairsToo) {
  const std::string pair = scene("stereo = { separation = 0.1 }\n");
  const Rendering one = render_text(pair, {.threads = 1});
  expect_same_bits(one.image, render_text(pair, {.threads = 5}).image);
  expect_same_bits(one.image, render_text(pair, {.crop = PixelBox{20, 10, 61, 44}}).image);
}

TEST(SameBits, ForAnyCrop) {
  const Rendering whole = render_text(scene());
  for (const PixelBox crop : {PixelBox{0, 0, 1, 1}, PixelBox{17, 5, 60, 40}, PixelBox{74, 52, 75, 53}}) {
    expect_same_bits(whole.image, render_text(scene(), {.crop = crop}).image);
  }
}

// Where each pixel chooses its samples, by what its neighbours show, and by what is smaller than it.
TEST(SameBits, WhereTheToleranceChoosesTheSamples) {
  const std::vector<std::string> tolerance = {"film.tolerance=0.02"};
  std::string text = scene("stereo = { separation = 0.1 }\n");
  text.erase(text.find("samples = 3\n"), 12);
  text +=
      "[[object]]\nshape = \"sphere\"\nradius = 0.02\nposition = [-1.4, 0.9, 1]\nbeta = [0, 0.4, 0]\n"
      "material = { emission = 200 }\n";
  const Rendering whole = render_text(text, {.threads = 1, .overrides = tolerance});
  ASSERT_GT(whole.statistics.samples.most, whole.statistics.samples.least);
  expect_same_bits(whole.image, render_text(text, {.threads = 5, .overrides = tolerance}).image);
  expect_same_bits(whole.image,
                   render_text(text, {.overrides = tolerance, .path = RayPath::one_by_one}).image);
  for (const PixelBox crop : {PixelBox{0, 0, 1, 1}, PixelBox{17, 5, 60, 40}, PixelBox{74, 52, 75, 53}}) {
    expect_same_bits(whole.image, render_text(text, {.crop = crop, .overrides = tolerance}).image);
  }
}

}  // namespace
}  // namespace backlight::test
