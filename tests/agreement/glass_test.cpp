// Glass: sheets give the law's bits, whatever the threads and the crop.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "rendering.h"
#include "same_bits.h"

namespace backlight::test {
namespace {

// Glass within glass, a bubble, boxes that touch, something opaque in one, coloured and clear, at rest and in
// two motions, under a lamp at rest and one that flies.
std::string scene(const std::string& camera, const std::string& more = {}) {
  return "[film]\nresolution = [48, 32]\nbounces = 10\n"
         "aovs = [\"Z\", \"doppler\", \"objectId\", \"N\", \"mirror\", \"light\"]\n"
         "[camera]\nposition = [0, 1.4, -6]\ndirection = [0, -0.15, 1]\n" +
         camera + two_lamps + R"toml(
[background]
color = [0.2, 0.3, 0.5]
[frame.passing]
velocity = [0.3, 0, -0.4]
[[object]]
shape = "plane"
position = [0, -1, 0]
material = { checker = { colors = [[0.8, 0.8, 0.7], [0.2, 0.2, 0.3]], size = 0.8 }, specular = 0.2 }
[[object]]
shape = "sphere"
radius = 1.1
position = [-1.5, 0.2, 1]
material = { glass = { index = 1.5, tint = [0.8, 0.9, 1] } }
[[object]]
shape = "sphere"
radius = 0.6
position = [-1.4, 0.3, 0.9]
material = { glass = { index = 1.33 } }
[[object]]
shape = "sphere"
radius = 0.25
position = [-1.5, 0.4, 0.7]
material = { glass = { index = 1 } }
[[object]]
shape = "box"
size = [0.8, 1.2, 0.8]
position = [0.6, -0.4, 0]
material = { glass = { index = 1.5 } }
[[object]]
shape = "box"
size = [0.8, 1.2, 0.8]
position = [1.4, -0.4, 0]
material = { glass = { index = 1.8, tint = [1, 0.6, 0.6] } }
[[object]]
shape = "sphere"
radius = 0.25
position = [0.6, -0.3, 0]
material = { color = [0.9, 0.2, 0.1], emission = 0.1 }
[[object]]
shape = "box"
size = [1.5, 2, 0.3]
frame = "passing"
position = [0.4, 1.2, 2]
rotate = [0, 25, 0]
material = { glass = { index = 1.6, tint = [0.7, 1, 0.8] }, specular = 0.3 }
[[object]]
shape = "sphere"
radius = 0.5
frame = "passing"
position = [2.2, 1.4, 2]
material = { glass = { index = 1.4 } }
[[object]]
shape = "sphere"
radius = 0.6
position = [-3, 0.6, 2]
material = { mirror = 0.9 }
)toml" + more;
}

void expect_the_law(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const Rendering a = render_text(text, {.overrides = overrides, .path = RayPath::one_by_one});
  const Rendering b = render_text(text, {.threads = 3, .overrides = overrides});
  EXPECT_GT(b.statistics.rays.passed_on, 200U);
  EXPECT_EQ(a.statistics.rays.passed_on, b.statistics.rays.passed_on);
  EXPECT_EQ(a.statistics.rays.ended, b.statistics.rays.ended);
  expect_same_bits(a.image, b.image);
  const PixelBox crop{11, 7, 34, 22};
  expect_same_bits(a.image, render_text(text, {.threads = 1, .crop = crop, .overrides = overrides}).image);
}

TEST(Glass, IsTheLawInSheetsForAnyThreadsAndCrop) {
  expect_the_law(scene(""));
  expect_the_law(scene("beta = [0.2, 0.1, 0.4]"), {"film.samples=3"});
  expect_the_law(scene("frame = \"passing\"", "[effects]\ndoppler = false\n"));
  expect_the_law(scene("projection = \"equirectangular\"", "[effects]\nsearchlight = \"paper\"\n"));
  expect_the_law(scene("stereo = { separation = 0.3 }",
                       "[[effects.region]]\nrect = [0.2, 0.2, 0.7, 0.8]\nlight_delay = false\n"));
  expect_the_law(scene("beta = [0, 0, 0.9]"));
}

TEST(Glass, IsTheLawWhereSamplesAreChosen) {
  expect_the_law(scene(""), {"film.tolerance=0.1"});
  expect_the_law(scene("beta = [0.2, 0.1, 0.4]"), {"film.tolerance=0.1", "film.resolution=[36, 24]"});
}

TEST(Glass, IsTheLawAroundTheCamera) {
  const std::string text = scene("frame = \"passing\"");
  std::string within = text;
  within.replace(within.find("position = [0, 1.4, -6]"), std::string("position = [0, 1.4, -6]").size(),
                 "position = [2.2, 1.4, 1.7]");
  expect_the_law(within);
  expect_the_law(within, {"film.tolerance=0.1", "film.resolution=[36, 24]"});
}

}  // namespace
}  // namespace backlight::test
