// Mirrors: sheets give the law's bits, whatever the threads and the crop.
#include <gtest/gtest.h>

#include "rendering.h"
#include "same_bits.h"

namespace backlight::test {
namespace {

// Mirrors of every kind of shape, coloured and grey, at rest, passing, fast and turning.
std::string scene(const std::string& film, const std::string& camera, const std::string& more = {}) {
  return "[film]\nresolution = [72, 48]\nbounces = 4\n"
         "aovs = [\"Z\", \"doppler\", \"objectId\", \"N\", \"mirror\", \"emissionTime\"]\n" +
         film + "\n[camera]\nposition = [0, 1.4, -7]\ndirection = [0, -0.12, 1]\n" + camera + two_lamps +
         R"toml(
[background]
color = [0.2, 0.3, 0.5]
[[object]]
shape = "plane"
position = [0, -1, 0]
material = { color = [0.5, 0.5, 0.4], mirror = 0.4, specular = 0.2 }
[[object]]
shape = "box"
size = [2, 3, 0.2]
position = [-3, 1, 3]
rotate = [0, 35, 0]
beta = [0.3, 0.1, -0.2]
material = { mirror = [0.9, 0.7, 0.5] }
[[object]]
shape = "sphere"
radius = 0.9
position = [0.2, 0.2, 1]
rotate = [0, 0, "30*t"]
scale = [1, 1.2, 1]
material = { mirror = 0.8 }
[[object]]
shape = "difference"
position = [2.4, 0.4, 2]
[[object.part]]
shape = "box"
size = [1.6, 1.6, 1.6]
material = { color = [0.7, 0.2, 0.1] }
[[object.part]]
shape = "sphere"
radius = 0.9
position = [0, 0.2, -0.8]
material = { mirror = 0.95 }
[[object]]
shape = "implicit"
f = "x^2 + y^2 + z^2 - 0.5 + 0.1*sin(5*x)"
bounds = [[-1, -1, -1], [1, 1, 1]]
position = [-1.8, 0, -0.5]
material = { mirror = 0.7 }
[[object]]
shape = "sphere"
radius = 0.5
position = [-0.4, 1.9, 0.4]
material = { emission = 0.8, emission_color = [0.3, 1, 0.5] }
)toml" + more;
}

// With this, no ray from a mirror goes in a sheet.
const std::string fast_mirror = R"toml(
[[object]]
shape = "torus"
major = 0.6
minor = 0.25
position = [1.6, 1.8, 0]
rotate = [60, 0, 20]
gamma = 50
along = [0, 0, 1]
material = { mirror = 0.9 }
)toml";

// Much else that sheets do: solids in frames of their own, checkers, textures of skies, all kinds of lamps.
const std::string more_to_see = R"toml(
[[light]]
type = "distant"
direction = [0.3, -1, 0.4]
irradiance = 0.4
beta = [0, 0.2, 0]
[[light]]
type = "spot"
position = [-2, 5, -3]
direction = [0.3, -1, 0.6]
intensity = "60 + 20*sin(3*t)"
angle = 50
[[light]]
type = "ambient"
radiance = 0.02
[[object]]
shape = "box"
size = [1, 1, 1]
position = [-0.5, 0, -9]
rotate = [10, 40, 0]
beta = [0.5, 0, 0.1]
material = { checker = { colors = [[0.8, 0.2, 0.2], [0.2, 0.2, 0.7]], size = 0.3 }, specular = 0.2 }
[[object]]
shape = "cone"
radius = 0.7
height = 1.5
position = [2.5, -1, -1]
beta = [-0.2, 0, 0.3]
material = { color = [0.3, 0.7, 0.3] }
[[object]]
shape = "torus"
major = 0.6
minor = 0.2
position = [1.5, 0.5, -8]
rotate = [70, 20, 0]
material = { emission = 0.2, temperature = 4000, color = [0.5, 0.5, 0.5] }
)toml";

void expect_the_law(const std::string& text, std::uint64_t least_in_sheets = 0) {
  RenderChoices law;
  law.path = RayPath::one_by_one;
  const Rendering a = render_text(text, law), b = render_text(text);
  EXPECT_GT(b.statistics.rays.passed_on, 300U);
  EXPECT_EQ(a.statistics.rays.passed_on, b.statistics.rays.passed_on);
  EXPECT_EQ(a.statistics.rays.ended, b.statistics.rays.ended);
  EXPECT_EQ(a.statistics.rays.passed_in_sheets, 0U);
  EXPECT_GE(b.statistics.rays.passed_in_sheets, least_in_sheets);
  expect_same_bits(a.image, b.image);
}

TEST(Mirrors, AreTheLawInSheets) {
  const std::string moving = "beta = [0.2, 0.1, 0.4]";
  for (const std::string& mirror : {std::string{}, fast_mirror}) {
    const std::uint64_t least = mirror.empty() ? 300U : 0U;
    expect_the_law(scene("", "", mirror), least);
    expect_the_law(scene("samples = 3", moving, mirror), least);
    expect_the_law(scene("", moving, "[effects]\ndoppler = false\n" + mirror), least);
    expect_the_law(
        scene("", "projection = \"equirectangular\"", "[effects]\nsearchlight = \"paper\"\n" + mirror));
    expect_the_law(scene("", "stereo = { separation = 0.3 }",
                         "[[effects.region]]\nrect = [0.2, 0.2, 0.7, 0.8]\nlight_delay = false\n" + mirror),
                   least);
    expect_the_law(scene("", "gamma = 200\nalong = [0, 0, 1]", mirror));
  }
}

TEST(Mirrors, ShowInSheetsWhatTheLawShows) {
  for (const char* camera : {"", "beta = [-0.3, 0.1, 0.2]"}) {
    for (const char* effects : {"", "[effects]\ndoppler = false\n", "[effects]\nsearchlight = \"off\"\n",
                                "[effects]\nlight_delay = false\n"})
      expect_the_law(scene("samples = 2", camera, effects + more_to_see), 600U);
  }
}

TEST(Mirrors, AndStarsInThemAreTheLawInSheets) {
  std::string text = scene("", "beta = [0.2, 0.1, 0.4]", more_to_see);
  text.replace(text.find("[72, 48]"), 8, "[36, 24]");
  const std::size_t sky = text.find("[background]") + 13;
  expect_the_law(text.substr(0, sky) + "stars = { count = 300 }\n" + text.substr(sky), 300U);
}

TEST(Mirrors, AreTheSameBitsForAnyThreadsAndCrop) {
  const std::string text = scene("", "beta = [0.2, 0.1, 0.4]");
  RenderChoices one, three, part;
  one.threads = 1;
  three.threads = 3;
  part.crop = PixelBox{11, 7, 52, 39};
  const Rendering a = render_text(text, one), b = render_text(text, three), c = render_text(text, part);
  expect_same_bits(a.image, b.image);
  expect_same_bits(a.image, c.image);
}

}  // namespace
}  // namespace backlight::test
