// Matter and lamps in motion: sheets of rays, threads and crops against one ray at a time. The same bits, or
// it is a defect.
#include <gtest/gtest.h>

#include <array>

#include "rendering.h"
#include "same_bits.h"

namespace backlight::test {
namespace {

const char* const aovs =
    "aovs = [\"Z\", \"doppler\", \"emissionTime\", \"properTime\", \"P\", \"N\", \"objectId\", "
    "\"unresolved\", \"light\"]\n";

// What turns in itself, swings, flies, flows, comes and goes, and solids of such parts; over things at rest.
std::string all_there_is(const std::string& camera) {
  return std::string("[film]\nresolution = [46, 34]\n") + aovs +
         "[camera]\nposition = [0, 1.5, -7]\nlook_at = [0, 0.4, 0]\nfov = 55\n" + camera + R"toml(
[frame.tram]
beta = [0.4, 0, 0.3]
origin = [2, 0.5, 2]
[[light]]
position = [3, 6, -3]
intensity = 90
[[light]]
position = ["-3 + 0.5*sin(t)", "3 + 0.4*t", "-2 + 0.5*cos(t)"]
intensity = "40*(1.3 + sin(5*t))"
temperature = 4000
[[light]]
position = [-1, 0, -2]
intensity = 20
frame = "tram"
rocket = { acceleration = 0.4, along = [0, 1, 1] }
[[light]]
type = "distant"
direction = [1, -2, 1]
[[object]]
shape = "plane"
position = [0, -1.5, 0]
[[object]]
shape = "box"
size = [2, 1, 1]
position = [-2, 0.2, 1]
rotate = ["10*t", "20*t", "15*sin(t)"]
material = { checker = { colors = [[0.9, 0.2, 0.2], [0.2, 0.2, 0.9]], size = 0.25 }, specular = 0.4 }
[[object]]
shape = "cylinder"
radius = 0.7
height = 1.2
position = [2, 0, 1]
rotate = [0, "60*t", 20]
material = { checker = { colors = [[0.9, 0.9, 0.2], [0.2, 0.2, 0.2]], size = 0.125 } }
repeat = { count = [2, 1, 2], step = [1.7, 0, 1.5] }
visible = "cos(5*t) + 0.4"
[[object]]
shape = "sphere"
radius = 0.6
position = [-0.6, 1.4, 1]
visible = "sin(9*t)"
[[object]]
shape = "sphere"
radius = 0.5
position = ["sin(0.6*t)", "1.5 + 0.3*cos(t)", 0]
visible = "sin(7*t) + 0.2"
[[object]]
shape = "torus"
major = 0.6
minor = 0.25
position = [-0.5, -0.5, -1]
frame = "tram"
rocket = { acceleration = 0.2, along = [0, 1, 0.4] }
[[object]]
shape = "difference"
position = [0, "0.3*sin(t)", 2]
material = { color = [0.3, 0.8, 0.4] }
[[object.part]]
shape = "box"
size = [1.4, 1.4, 1.4]
[[object.part]]
shape = "sphere"
radius = 0.6
position = ["0.6*cos(0.5*t)", "0.6*sin(0.5*t)", -0.7]
material = { color = [0.9, 0.5, 0.1] }
[[object]]
shape = "union"
blend = 0.3
position = ["-3.5 + 0.2*t", 1.6, 1]
[[object.part]]
shape = "sphere"
radius = 0.5
[[object.part]]
shape = "box"
size = [0.5, 1, 0.5]
position = [0.4, 0.2, 0]
[[object]]
shape = "implicit"
f = "x^2 + y^2 + z^2 - 0.3 - 0.1*sin(t)"
bounds = [[-1, -1, -1], [1, 1, 1]]
position = [1.5, 1.7, 0]
matter_velocity = ["0.2*x", "0.2*y", "0.2*z"]
)toml";
}

// Many on circles, in two frames, and some that go away: more than lamps look at one by one.
std::string a_crowd_on_circles(const std::string& camera) {
  std::string scene = std::string("[film]\nresolution = [46, 34]\n") + aovs +
                      "[camera]\nposition = [0, 1.5, -7]\nlook_at = [0, 0.4, 0]\nfov = 55\n" + camera +
                      R"toml(
[frame.tram]
beta = [0.4, 0, 0.3]
origin = [2, 0.5, 2]
[[light]]
position = [3, 6, -3]
intensity = 90
[[light]]
position = [-1, 2, -2]
intensity = 20
frame = "tram"
[[light]]
type = "distant"
direction = [1, -2, 1]
[[object]]
shape = "plane"
position = [0, -1.5, 0]
)toml";
  for (int i = 0; i < 70; ++i) {
    const double x = 0.37 * (i % 13) - 2.4, y = 0.3 * (i % 7) - 1.0, z = 0.31 * (i % 11) - 1.5;
    const double orbit = 0.4 + 0.2 * (i % 3), rate = (0.2 + 0.01 * i) / orbit;
    const std::string angle = "(" + std::to_string(rate) + "*t + " + std::to_string(i) + ")";
    const std::string away = i % 9 == 0 ? " + 0.03*t" : i % 10 == 0 ? " + 0.02*sqrt(1 + t^2)" : "";
    scene += "[[object]]\nshape = \"sphere\"\nradius = 0.2\nposition = [\"" + std::to_string(x) + " + " +
             std::to_string(orbit) + "*cos" + angle + away + "\", " + std::to_string(y) + ", \"" +
             std::to_string(z) + " + " + std::to_string(orbit) + "*sin" + angle + "\"]\n" +
             (i % 4 == 0 ? "frame = \"tram\"\n" : "");
  }
  return scene;
}

class MovingMatterInSheets : public testing::TestWithParam<std::pair<const char*, std::vector<std::string>>> {
};

void expect_the_law(const std::string& scene, const std::vector<std::string>& overrides) {
  RenderChoices choices;
  choices.overrides = overrides;
  const Rendering sheets = render_text(scene, choices);
  choices.path = RayPath::one_by_one;
  expect_same_bits(sheets.image, render_text(scene, choices).image);
  choices.path = RayPath::sheets;
  choices.threads = 1;
  choices.instructions = InstructionSet::baseline;
  expect_same_bits(sheets.image, render_text(scene, choices).image);
  choices.threads = 5;
  choices.crop = PixelBox{7, 11, 32, 26};
  expect_same_bits(sheets.image, render_text(scene, choices).image);
}

TEST_P(MovingMatterInSheets, IsTheLaw) {
  expect_the_law(all_there_is(GetParam().first), GetParam().second);
}

TEST_P(MovingMatterInSheets, IsTheLawOfCrowds) {
  expect_the_law(a_crowd_on_circles(GetParam().first), GetParam().second);
}

INSTANTIATE_TEST_SUITE_P(
    Cameras, MovingMatterInSheets,
    testing::Values(std::pair{"", std::vector<std::string>{}},
                    std::pair{"beta = [0.2, 0.1, 0.5]\ntime = 1.5\n", std::vector<std::string>{}},
                    std::pair{"gamma = 60\nalong = [0.1, 0, -1]\n", std::vector<std::string>{}},
                    std::pair{"", std::vector<std::string>{"effects={ doppler = false }"}},
                    std::pair{"beta = [0, 0, 0.4]\n",
                              std::vector<std::string>{"effects={ light_delay = false }"}},
                    std::pair{"projection = \"equirectangular\"\nstereo = { separation = 0.3 }\n",
                              std::vector<std::string>{}},
                    std::pair{"projection = \"fisheye\"\n", std::vector<std::string>{"film.samples=3"}}));

}  // namespace
}  // namespace backlight::test
