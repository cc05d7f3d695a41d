// Sheets of rays against the law: one ray at a time, every object asked. The same bits, or it is a defect.
// Longer than 400 lines: one list of scenes, which share what makes and compares them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "backlight/base/lane_power.h"
#include "meshes.h"
#include "rendering.h"

namespace backlight::test {
namespace {

std::string vec(double x, double y, double z) {
  char text[120];
  std::snprintf(text, sizeof text, "[%.17g, %.17g, %.17g]", x, y, z);
  return text;
}

struct Field {
  int spheres = 10;
  double gamma = 1.0;  ///< up to this
  int frames = 0;      ///< share so many; 0: each its own
  int width = 96;
  int height = 64;
  std::string film;
  std::string camera;
  std::string top;
  std::string more;
  double density = 1.0;
};

// Spheres in front of the camera, placed so that it sees them where they would rest.
std::string scene_of(const Field& f) {
  std::mt19937 random(7);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  std::string s =
      "[film]\nresolution = [" + std::to_string(f.width) + ", " + std::to_string(f.height) +
      "]\naovs = [\"Z\", \"doppler\", \"emissionTime\", \"properTime\", \"P\", \"N\", \"objectId\"]\n" +
      f.film + "\n" + f.top + "\n[camera]\nposition = [0, 1, -9]\nlook_at = [0, 0, 0]\ntime = 0\n" +
      f.camera +
      "\n[[light]]\nposition = [-6, 9, -7]\nintensity = 200\n"
      "[[object]]\nshape = \"plane\"\nposition = [0, -1.5, 0]\n"
      "material = { color = [0.8, 0.8, 0.8], specular = 0.4, shininess = 40 }\n";
  std::vector<Vec3> shared;
  const auto velocity = [&] {
    const double g = uniform(1.0, f.gamma);
    const double v = std::sqrt((1.0 - 1.0 / g) * (1.0 + 1.0 / g));
    const double z = uniform(-1, 1), a = uniform(0, 6.283185), r = std::sqrt(1 - z * z);
    return v * Vec3(r * std::cos(a), r * std::sin(a), z);
  };
  for (int i = 0; i < f.frames; ++i) shared.push_back(velocity());
  for (int i = 0; i < f.spheres; ++i) {
    const Vec3 x{uniform(-5, 5), uniform(-1.2, 3), uniform(-4, 8)};
    const Vec3 v = f.frames > 0 ? shared[static_cast<std::size_t>(i % f.frames)] : velocity();
    const Vec3 now = x + v * glm::length(x - Vec3{0, 1, -9});
    const double radius = f.density * uniform(0.2, 0.5) * std::pow(30.0 / (f.spheres + 20), 1.0 / 3.0);
    s += "[[object]]\nshape = \"sphere\"\nradius = " + std::to_string(radius) +
         "\nposition = " + vec(now.x, now.y, now.z) + "\n";
    if (f.gamma > 1.0) s += "beta = " + vec(v.x, v.y, v.z) + "\n";
    s += "material = { color = " + vec(uniform(0, 1), uniform(0, 1), uniform(0, 1)) +
         ", specular = 0.3, shininess = 30 }\n";
  }
  return s + f.more;
}

std::size_t different_values(const Image& a, const Image& b) {
  std::size_t different = 0;
  for (std::size_t channel = 0; channel < a.channel_count(); ++channel) {
    const auto x = a.plane(channel), y = b.plane(channel);
    for (std::size_t i = 0; i < x.size(); ++i)
      different += std::memcmp(&x[i], &y[i], sizeof x[i]) != 0 ? 1 : 0;
  }
  return different;
}

void expect_the_law(const std::string& scene, const RenderChoices& choices = {}) {
  RenderChoices law = choices;
  law.path = RayPath::one_by_one;
  const Rendering expected = render_text(scene, law);
  for (const InstructionSet set : {InstructionSet::widest, InstructionSet::avx2, InstructionSet::baseline}) {
    RenderChoices sheets = choices;
    sheets.instructions = set;
    const Rendering got = render_text(scene, sheets);
    EXPECT_EQ(different_values(expected.image, got.image), 0u) << "instruction set " << static_cast<int>(set);
    EXPECT_EQ(expected.statistics.rays.primary, got.statistics.rays.primary);
    EXPECT_EQ(expected.statistics.rays.shadow, got.statistics.rays.shadow);
  }
}

const RenderChoices three_colours{.overrides = {"effects.doppler=false"}};

class SheetsOfSpheres : public testing::TestWithParam<std::tuple<int, double>> {};

TEST_P(SheetsOfSpheres, AreTheLaw) {
  const auto [spheres, gamma] = GetParam();
  const int size = spheres > 500 ? 48 : 96;
  expect_the_law(scene_of({.spheres = spheres, .gamma = gamma, .width = size, .height = size / 3 * 2}),
                 three_colours);
}

INSTANTIATE_TEST_SUITE_P(Fields, SheetsOfSpheres,
                         testing::Combine(testing::Values(10, 200, 1000),
                                          testing::Values(1.0, 1.2, 3.0, 30.0, 1e4)));

// So many spheres that shadow rays are sorted into packets, for two lights and regions of other effects. A
// ball around everything is seen from within, and its shadow rays start from within; what else lanes cannot
// decide about is here too.
TEST(Sheets, AreTheLawInSortedPackets) {
  const std::string more = R"toml(
[[light]]
position = [3, 4, -5]
beta = [0.2, 0.3, 0]
intensity = "100 + 60*sin(3*t)"
[[object]]
shape = "sphere"
radius = 9.5
position = [0, 1, -9]
material = { color = [0.2, 0.4, 0.8] }
[[object]]
shape = "torus"
major = 1
minor = 0.3
rotate = [50, 20, 0]
position = [1, 1, -1]
beta = [0.5, 0.1, 0.2]
[[object]]
shape = "sphere"
radius = 0.8
scale = [1, 0.5, 1.5]
position = [-3, 0, -2]
beta = [0, 0.4, 0.4]
material = { checker = { colors = [[0.8, 0.8, 0.1], [0.1, 0.1, 0.9]], size = 0.1 } }
)toml";
  const std::string regions = "[[effects.region]]\nrect = [0.3, 0.2, 0.7, 0.9]\nlight_delay = false\n";
  for (const double gamma : {3.0, 40.0}) {
    Field field{.spheres = 1600, .gamma = gamma, .width = 40, .height = 27, .top = regions, .density = 1.5};
    expect_the_law(scene_of(field), three_colours);
    field.more = more;
    expect_the_law(scene_of(field), three_colours);
  }
}

TEST(Sheets, AreTheLawWithSpectra) {
  expect_the_law(scene_of({.spheres = 40, .gamma = 3.0, .width = 48, .height = 32}));
}

// Every kind of spectrum, on surfaces at rest and in motion; of wavelengths as many as fill registers, and
// not.
TEST(Sheets, AreTheLawWithAllKindsOfSpectra) {
  const std::string more =
      "[background]\ntemperature = 3000\nbeta = [0, 0.5, 0]\n"
      "[[light]]\nposition = [5, 8, -6]\nintensity = 100\ntemperature = 2500\nbeta = [0.5, 0, 0.3]\n"
      "[[light]]\nposition = [0, 8, -6]\nintensity = 100\ncolor = [1, 0.6, 0.2]\nbeta = [0, -0.4, 0.3]\n"
      "[[light]]\ntype = \"distant\"\ndirection = [0.4, -1, 0.3]\nirradiance = 1\n"
      "spectrum = { wavelengths = [400, 500, 640, 700], values = [1, 0.2, 0.8, 0.1] }\n"
      "[[light]]\ntype = \"ambient\"\nradiance = 0.1\n"
      "[[object]]\nshape = \"box\"\nsize = [2, 2, 2]\nposition = [1, 0, 3]\n"
      "material = { checker = { colors = [[0.9, 0.1, 0.1], [0.4, 0.4, 0.4]], size = 0.5 }, specular = 0.2 }\n"
      "[[object]]\nshape = \"sphere\"\nradius = 0.8\nposition = [-2, 0, 1]\nbeta = [0.3, 0.2, -0.6]\n"
      "material = { color = [0.2, 0.3, 0.9], uv = 0.7, ir = 0.1, emission = 0.3, emission_color = [0.5, 0.1, "
      "0.2] }\n"
      "[[object]]\nshape = \"sphere\"\nradius = 0.5\nposition = [0, 0, 0]\n"
      "material = { color = [0.1, 0.3, 0.2], temperature = 4000, emission = 0.2 }\n"
      "[[object]]\nshape = \"sphere\"\nradius = 0.5\nposition = [2, 1, 0]\nbeta = [-0.9, 0, 0]\n"
      "material = { spectrum = { wavelengths = [300, 500, 900], values = [0.1, 0.9, 0.2] } }\n";
  for (const char* camera : {"", "beta = [0.1, 0.2, 0.6]\n"}) {
    for (const char* film : {"wavelengths = 56", "wavelengths = 13"}) {
      expect_the_law(scene_of({.spheres = 8,
                               .gamma = 2.0,
                               .width = 48,
                               .height = 32,
                               .film = film,
                               .camera = camera,
                               .more = more}));
    }
  }
}

TEST(Sheets, AreTheLawInSharedFrames) {
  for (const int frames : {1, 8}) {
    expect_the_law(scene_of({.spheres = 300, .gamma = 2.0, .frames = frames, .width = 48, .height = 32}),
                   three_colours);
  }
}

// Frames of many boxes, cones and cylinders are searched by their trees, with planes and spheres beside them;
// some faces lie in a plane that is written before or after them.
TEST(Sheets, AreTheLawInTreesOfFrames) {
  std::mt19937 random(5);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  std::string more;
  const char* shapes[] = {"shape = \"box\"\nsize = [0.4, 0.5, 0.6]\n",
                          "shape = \"cylinder\"\nradius = 0.2\nheight = 0.6\n",
                          "shape = \"cone\"\nradius = 0.3\ntop_radius = 0\nheight = 0.7\n"};
  for (int i = 0; i < 48; ++i) {
    more += std::string("[[object]]\n") + shapes[i % 3] +
            "position = " + vec(uniform(-5, 5), uniform(-1.2, 3), uniform(-4, 8)) +
            "\nrotate = " + vec(uniform(0, 90), uniform(0, 90), 0) + "\n";
    if (i % 4 != 0) more += "beta = " + vec(i % 4 == 1 ? 0.6 : -0.3, 0.0, i % 4 == 2 ? 0.7 : 0.1) + "\n";
  }
  for (int i = 0; i < 12; ++i) {
    more += "[[object]]\nshape = \"box\"\nsize = [0.9, 1, 0.9]\nposition = " +
            vec(i - 6.0, i % 2 == 0 ? -2.0 : -1.9, 0.5 * i - 4.0) + "\nmaterial = { color = [1, 0, 0] }\n";
  }
  more += "[[object]]\nshape = \"plane\"\nposition = [0, -1.4, 0]\nmaterial = { color = [0, 1, 0] }\n";
  const std::string sun = "[[light]]\ntype = \"distant\"\ndirection = [0.4, -1, 0.3]\nirradiance = 1\n";
  for (const std::string& scene : {more, more + sun}) {
    expect_the_law(scene_of({.spheres = 12, .gamma = 40.0, .width = 96, .height = 64, .more = scene}),
                   three_colours);
  }
}

TEST(Sheets, AreTheLawInEveryProjection) {
  for (const char* projection : {"equirectangular", "mercator", "fisheye", "cubemap"}) {
    expect_the_law(scene_of({.spheres = 60,
                             .gamma = 3.0,
                             .width = 72,
                             .height = 48,
                             .camera = std::string("projection = \"") + projection + "\"\n"}),
                   three_colours);
  }
}

TEST(Sheets, AreTheLawThroughAScreen) {
  std::string scene = scene_of({.spheres = 60, .gamma = 3.0, .width = 64, .height = 48});
  const std::string aim = "look_at = [0, 0, 0]\n";
  scene.replace(
      scene.find(aim), aim.size(),
      "screen = { lower_left = [3, -2, -6], lower_right = [-5, -2, -5], upper_left = [3, 4, -6] }\n");
  expect_the_law(scene, three_colours);
}

// Spot lamps at rest, passing, on a path and flickering, of which each lights a part.
TEST(Sheets, AreTheLawUnderSpotLamps) {
  const std::string lamps = R"toml(
[[light]]
type = "spot"
position = [2, 5, -4]
direction = [-1, -4, 2]
angle = 50
edge = 0.3
intensity = "80 + 30*sin(5*t)"
[[light]]
type = "spot"
position = [-4, 4, -6]
beta = [0.5, -0.1, 0.3]
direction = [1, -1, 1]
angle = 80
edge = 1
intensity = 90
[[light]]
type = "spot"
position = ["2*cos(0.4*t)", 4, "2*sin(0.4*t) - 3"]
direction = [0, -1, 0]
angle = 100
intensity = 60
[[light]]
type = "spot"
position = [0, 3, -4]
gamma = 50
along = [1, 0, 1]
direction = [0, -1, 0.5]
angle = 120
edge = 0.5
intensity = 40
)toml";
  const Field field{.spheres = 60, .gamma = 2.0, .width = 64, .height = 48, .more = lamps};
  expect_the_law(scene_of(field));
  expect_the_law(scene_of(field), three_colours);
}

TEST(Sheets, AreTheLawForAMovingCameraAndManySamples) {
  expect_the_law(scene_of({.spheres = 60,
                           .gamma = 3.0,
                           .width = 40,
                           .height = 30,
                           .film = "samples = 5",
                           .camera = "beta = [0.3, -0.1, 0.6]"}),
                 three_colours);
}

TEST(Sheets, AreTheLawForStereoPairs) {
  for (const char* projection : {"perspective", "equirectangular", "fisheye"}) {
    expect_the_law(scene_of({.spheres = 60,
                             .gamma = 3.0,
                             .width = 40,
                             .height = 30,
                             .camera = std::string("stereo = { separation = 0.8 }\nprojection = \"") +
                                       projection + "\"\n"}),
                   three_colours);
  }
}

TEST(Sheets, AreTheLawForCrops) {
  RenderChoices crop = three_colours;
  crop.crop = PixelBox{13, 7, 61, 50};
  expect_the_law(scene_of({.spheres = 60, .gamma = 3.0}), crop);
}

TEST(Sheets, AreTheLawWhereEffectsDiffer) {
  const std::string regions =
      "[[effects.region]]\nrect = [0.3, 0.2, 0.7, 0.9]\nlight_delay = false\n"
      "[[effects.region]]\nrect = [0.5, 0.4, 0.8, 0.7]\nsearchlight = \"paper\"\ndoppler = false\n";
  for (const double gamma : {3.0, 1e4}) {
    expect_the_law(scene_of({.spheres = 80, .gamma = gamma, .width = 48, .height = 32, .top = regions}));
  }
}

// Every kind of surface, material and light at once.
TEST(Sheets, AreTheLawForAllThereIs) {
  const std::string more = R"toml(
[[light]]
type = "distant"
direction = [0.3, -1, 0.5]
irradiance = 0.7
[[light]]
position = [3, 4, -5]
beta = [0.2, 0.3, 0]
intensity = "100 + 60*sin(3*t)"
[[light]]
type = "ambient"
radiance = 0.05
[[object]]
shape = "torus"
major = 1
minor = 0.3
rotate = [50, 20, 0]
position = [1, 1, -1]
beta = [0.5, 0.1, 0.2]
[[object]]
shape = "box"
size = [1, 2, 0.5]
rotate = [20, 30, 10]
position = [-2, 1, 0]
beta = [0.5, 0.1, 0.2]
material = { emission = 0.2 }
[[object]]
shape = "cylinder"
radius = 0.4
height = 2
position = [2, 0, 2]
material = { checker = { colors = [[0.8, 0.8, 0.8], [0.3, 0.1, 0.1]], size = 0.1 } }
[[object]]
shape = "sphere"
radius = 0.8
scale = [1, 0.5, 1.5]
rotate = [10, 20, 30]
position = [-3, 0, -2]
beta = [0, 0.4, 0.4]
material = { checker = { colors = [[0.8, 0.8, 0.1], [0.1, 0.1, 0.9]], size = 0.1 } }
[[object]]
shape = "plane"
position = [0, 0, 30]
rotate = [80, 10, 0]
beta = [0.1, 0, 0.2]
material = { checker = { colors = [[0.8, 0.2, 0.2], [0.2, 0.2, 0.9]], size = 2 } }
[[object]]
shape = "cone"
radius = 0.5
top_radius = 0.1
height = 1
position = [0, 0, -3]
gamma = 1e5
along = [0.1, 0, 1]
[background]
color = [0.1, 0.2, 0.4]
stars = { count = 500, seed = 4 }
)toml";
  const Field all{.spheres = 90, .gamma = 2.0, .width = 60, .height = 40, .more = more};
  expect_the_law(scene_of(all));
  expect_the_law(scene_of(all), three_colours);
  RenderChoices fill = three_colours;
  fill.overrides.insert(fill.overrides.end(), {"light.1.shadows=false", "light.2.shadows=false"});
  expect_the_law(scene_of(all), fill);
}

// Materials by their own time, at rest, in motion, and of a solid's members.
TEST(Sheets, AreTheLawForMaterialsInTime) {
  const std::string more = R"toml(
[[light]]
position = [3, 4, -5]
beta = [0.2, 0.3, 0]
intensity = 100
temperature = 3000
[[light]]
type = "distant"
direction = [0.3, -1, 0.5]
irradiance = "0.7 + 0.2*sin(t)"
[[light]]
type = "ambient"
radiance = 0.05
[[object]]
shape = "torus"
major = 1
minor = 0.3
rotate = [50, 20, 0]
position = [1, 1, -1]
beta = [0.5, 0.1, 0.2]
material = { color = ["0.5 + 0.6*sin(t)", 0.3, "0.5 + 0.6*cos(2*t)"], specular = "0.5*sin(9*t)", uv = "sin(t)" }
[[object]]
shape = "box"
size = [1, 2, 0.5]
rotate = [20, 30, 10]
position = [-2, 1, 0]
beta = [0.5, 0.1, 0.2]
material = { emission = "0.2*sin(9*t)", color = [0.1, 0.2, 0.3], specular = 0.2, shininess = "20 + 10*sin(t)" }
[[object]]
shape = "sphere"
radius = 0.8
position = [2, 0, 2]
material = { emission = 0.3, temperature = "3000*sin(5*t)", color = [0.4, 0.2, 0.1] }
[[object]]
shape = "sphere"
radius = 0.8
scale = [1, 0.5, 1.5]
position = [-3, 0, -2]
beta = [0, 0.4, 0.4]
material = { checker = { colors = [["sin(t)", 0.8, 0.1], [0.1, 0.1, 0.9]], size = 0.1 }, emission = 0.1, emission_color = [1, "cos(t)", 0] }
[[object]]
shape = "union"
position = [0, -1, -2]
beta = [0.3, 0.1, 0]
[[object.part]]
shape = "sphere"
radius = 0.6
material = { color = [0.9, 0.2, 0.2], emission = "sin(20*t)" }
[[object.part]]
shape = "box"
size = [0.8, 0.8, 0.8]
position = [0.5, 0, 0]
material = { color = [0.9, 0.2, 0.2] }
[[object]]
shape = "plane"
position = [0, -4, 0]
material = { color = [0.5, 0.5, "0.3 + 0.3*sin(t)"] }
)toml";
  const Field all{.spheres = 30, .gamma = 2.0, .width = 60, .height = 40, .more = more};
  expect_the_law(scene_of(all));
  expect_the_law(scene_of(all), three_colours);
}

// Solids take one ray at a time, after the cones.
TEST(Sheets, AreTheLawForManySurfacesOfAFrame) {
  std::string more;
  for (int i = 0; i < 80; ++i) {
    more += "[[object]]\nshape = \"box\"\nsize = [0.3, 0.2, 0.4]\nrotate = [" + std::to_string(7 * i) +
            ", 20, 0]\nposition = [" + std::to_string(i % 10 * 0.6 - 3) + ", " +
            std::to_string(i / 10 * 0.4 - 1) + ", 1]\nbeta = [0.3, 0.2, 0.5]\n";
  }
  expect_the_law(scene_of({.spheres = 20, .gamma = 2.0, .width = 60, .height = 40, .more = more}),
                 three_colours);
}

// What casts no shadow is passed over by every way of shading: by kernels, trees, packets and the law, in its
// own frame and in others; lamps are inside of some.
TEST(Sheets, AreTheLawWhereThingsCastNoShadow) {
  const std::string clear = "casts_shadow = false\n";
  std::string more =
      "[[light]]\nposition = [1, 1, -1]\nbeta = [0.2, 0.3, 0]\nintensity = \"20 + 6*sin(3*t)\"\n"
      "[[light]]\ntype = \"distant\"\ndirection = [0.3, -1, 0.5]\nirradiance = 0.7\n"
      "[[object]]\nshape = \"sphere\"\nradius = 0.7\nposition = [1, 1, -1]\nbeta = [0.2, 0.3, 0]\n" +
      clear + "[[object]]\nshape = \"plane\"\nposition = [0, 12, 0]\nrotate = [10, 0, 0]\n" + clear +
      "[[object]]\nshape = \"torus\"\nmajor = 1\nminor = 0.3\nposition = [-1, 1, -3]\n" + clear +
      "[[object]]\nshape = \"implicit\"\nf = \"x^2+y^2+z^2-1+0.2*sin(5*x+t)\"\n"
      "bounds = [[-2, -2, -2], [2, 2, 2]]\nposition = [2, 1, -3]\nbeta = [0, 0.3, 0.3]\n" +
      clear + "[[object]]\nshape = \"difference\"\nposition = [-3, 1, -1]\nbeta = [0.5, 0, 0.3]\n" + clear +
      "[[object.part]]\nshape = \"box\"\nsize = [1, 2, 1]\n"
      "[[object.part]]\nshape = \"sphere\"\nradius = 0.6\n";
  for (int i = 0; i < 24; ++i) {
    more += "[[object]]\nshape = \"box\"\nsize = [0.4, 0.5, 0.6]\nposition = " +
            vec(i % 6 - 3.0, i / 6 - 1.0, -2.0) + "\nbeta = [0.3, 0.2, 0.4]\n" + (i % 2 == 0 ? clear : "");
  }
  more +=
      "[[object]]\nshape = \"sphere\"\nradius = 0.06\nposition = [-4, -1, -3]\n"
      "repeat = { count = [9, 9, 3], step = [1, 0.5, 1] }\n" +
      clear;
  const std::string all = scene_of({.spheres = 40, .gamma = 40.0, .width = 60, .height = 40, .more = more});
  expect_the_law(all, three_colours);
  std::string dark = all;
  for (std::size_t at = 0; (at = dark.find(clear)) != std::string::npos;) dark.erase(at, clear.size());
  EXPECT_GT(different_values(render_text(all, three_colours).image, render_text(dark, three_colours).image),
            100u);
  expect_the_law(scene_of({.spheres = 1600, .gamma = 3.0, .width = 40, .height = 27, .more = more}),
                 three_colours);
}

// Formulas, by either search, with a clock, with texture coordinates, with roots that are not resolved, and
// with members.
TEST(Sheets, AreTheLawForFormulas) {
  const std::string more = R"toml(
[[light]]
position = [3, 4, -5]
beta = [0.2, 0.3, 0]
intensity = 100
[[object]]
shape = "implicit"
f = "4*(2.618*x^2-y^2)*(2.618*y^2-z^2)*(2.618*z^2-x^2) - 4.236*(x^2+y^2+z^2-1)^2"
bounds = [[-1.5, -1.5, -1.5], [1.5, 1.5, 1.5]]
position = [1, 1, 0]
beta = [0.5, 0.1, 0.2]
[[object]]
shape = "implicit"
f = "sqrt((sqrt(x^2+z^2)-1)^2+y^2) - 0.3 - 0.1*sin(t)"
bounds = [[-1.5, -0.5, -1.5], [1.5, 0.5, 1.5]]
position = [-2, 0, 1]
rotate = [50, 20, 0]
material = { checker = { colors = [[0.8, 0.8, 0.8], [0.3, 0.1, 0.1]], size = 0.1 } }
[[object]]
shape = "implicit"
f = "(x^2+y^2+z^2-1)^2*(x+0.2*t)"
bounds = [[-1.1, -1.1, -1.1], [1.1, 1.1, 1.1]]
position = [0, -1, -2]
beta = [0, 0.3, 0.3]
[[object]]
shape = "union"
blend = 0.3
position = [2, -1, 1]
[[object.part]]
shape = "sphere"
radius = 0.6
material = { color = [0.9, 0.2, 0.2] }
[[object.part]]
shape = "torus"
major = 0.8
minor = 0.2
position = [0.4, 0, 0]
material = { color = [0.2, 0.2, 0.9] }
)toml";
  const Field formulas{.spheres = 5, .gamma = 2.0, .width = 60, .height = 40, .more = more};
  expect_the_law(scene_of(formulas));
  expect_the_law(scene_of(formulas), three_colours);
}

TEST(LanePower, IsTheSameForAnyWidth) {
  for (int i = 1; i < 2000; ++i) {
    const double base = i / 2000.0, exponent = 0.37 * i;
    const double one = power(base, exponent);
    EXPECT_EQ(power(Lanes<2>(base), Lanes<2>(exponent)).v[1], one);
    const double exact = std::pow(base, exponent);
    const double bound = (4.0 * std::abs(exponent * std::log2(base)) + 8.0) * 0x1p-53;
    if (exact <= 1e-300) continue;
    EXPECT_LE(std::abs(one / exact - 1.0), bound + 0x1p-53) << base << ' ' << exponent;
  }
}

/// A mesh file of the test's own: a path for a scene.
std::string mesh_file(const std::string& name, const MeshData& mesh) {
  const std::string path = ::testing::TempDir() + name;
  write_obj(path, mesh);
  return path;
}

TEST(Sheets, OfMeshesAreTheLaw) {
  const std::string ball = mesh_file("sheets_ball.obj", icosphere(3, 1.0));
  const std::string ring = mesh_file("sheets_ring.obj", torus_mesh(1.0, 0.3, 40, 20));
  const std::string cube = mesh_file("sheets_cube.obj", box_mesh(Vec3{1.0}));
  const auto mesh = [](const std::string& file, const std::string& more) {
    return "[[object]]\nshape = \"mesh\"\nfile = \"" + file + "\"\n" + more + "\n";
  };
  for (const char* beta : {"[0, 0, 0]", "[0.6, 0.3, -0.2]"}) {
    Field field;
    field.spheres = 3;
    field.more =
        mesh(ball, "position = [-1.5, 0, 0]\nbeta = " + std::string(beta)) +
        mesh(ball, "position = [\"-0.5 + 0.5*t\", \"-1 + 0.3*t\", 1]\nscale = [0.5, 0.7, 0.5]") +
        mesh(ball,
             "position = [1.5, 0.2, 0]\nsmooth = false\nrotate = [20, 30, 40]\nscale = [1, 0.5, -0.8]") +
        mesh(ring,
             "position = [0, 1, 1]\nrotate = [60, 0, 0]\nrepeat = { count = [2, 1, 2], step = [1, 1, 3] }") +
        "[[object]]\nshape = \"difference\"\nposition = [0, 0, -3]\n[[object.part]]\nshape = \"mesh\"\nfile "
        "= \"" +
        cube + "\"\n[[object.part]]\nshape = \"sphere\"\nradius = 0.6\nmaterial = { color = [1, 0, 0] }\n";
    expect_the_law(scene_of(field));
  }
  // As fast as the extended arithmetic is for.
  Field fast;
  fast.spheres = 0;
  fast.camera = "gamma = 1e6\nalong = [0, 0, 1]\n";
  fast.more = mesh(ball, "position = [0, 0, 3e6]");
  expect_the_law(scene_of(fast));
}

}  // namespace
}  // namespace backlight::test
