// Whatever is read, the reader answers: with a scene, or with errors whose places are in the text. The texts
// are a scene with every section, changed at random (the same changes every time).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "backlight/scene/compile.h"
#include "backlight/scene/explain.h"
#include "compiled.h"

namespace backlight {
namespace {

const std::string whole_scene = R"toml(c = 5.0
[params]
v = 4.5
w = "v/2 + 0*t"
[animation]
fps = 25
frames = [1, 250]
[film]
resolution = [72, 52]
samples = 16
aovs = ["Z", "doppler", "emissionTime", "properTime", "P", "N", "objectId"]
[camera]
position = [0, 1.6, -12]
look_at = [0, 1, 0]
up = [0, 1, 0]
velocity = ["v/9", 0, 0]
time = "t"
fov = 60
stereo = { separation = 0.065 }
[frame.tram]
velocity = [4.5, 0, 0]
origin = [0, 0, 0]
origin_time = 0
within = "world"
[frame.bird]
rapidity = 0.5
along = [1, 2, 3]
within = "tram"
[material.brick]
color = [0.6, 0.25, 0.2]
specular = 0.1
shininess = 50
emission = 0.5
temperature = 3000
[[light]]
type = "point"
position = [0, 8, 0]
intensity = "300*clamp(sin(t), 0, 1)"
temperature = 6500
[[light]]
type = "distant"
direction = [1, -1, 0]
irradiance = 2
velocity = ["w/3", 0, 0]
[[object]]
name = "body"
shape = "box"
size = [8, 3, 2.5]
position = [0, 1.8, 0]
rotate = [0, 30, 0]
scale = [1, 1, 2]
frame = "tram"
material = "brick"
repeat = { count = [10, 1, 1], step = [4, 0, 0] }
[[object]]
shape = "torus"
major = 2
minor = 0.5
frame = "bird"
material = { checker = { colors = [[1, 1, 1], [0, 0, 0]], size = 0.5 } }
[background]
color = [0.5, 0.7, 1.0]
stars = { count = 9, seed = 1 }
[effects]
searchlight = "paper"
[[effects.region]]
rect = [0.3, 0.3, 0.7, 0.7]
doppler = false
)toml";

// xorshift64: Marsaglia, "Xorshift RNGs", Journal of Statistical Software 8(14), 2003.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 2685821657736338717ULL + 1) {}
  std::size_t below(std::size_t n) {
    state_ ^= state_ << 13U;
    state_ ^= state_ >> 7U;
    state_ ^= state_ << 17U;
    return static_cast<std::size_t>(state_ % n);
  }

 private:
  std::uint64_t state_;
};

std::string changed(std::string text, Dice& dice) {
  const std::vector<std::string> pieces{
      "0",  "-1", "1e308", "nan",  "\"t\"",        "\"1/0\"",        "[",         "]",    "{", "}", "=",
      "\n", "\"", ".",     "true", "[[object]]\n", "[frame.tram]\n", "\"world\"", "\xff", "é", "#", ","};
  const std::size_t changes = 1 + dice.below(4);
  for (std::size_t i = 0; i < changes; ++i) {
    const std::size_t at = dice.below(text.size());
    const std::size_t length = 1 + dice.below(12);
    const std::size_t digit = text.find_first_of("0123456789", at);
    switch (dice.below(8)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, pieces[dice.below(pieces.size())]);
        break;
      case 2:
        text.replace(at, length, pieces[dice.below(pieces.size())]);
        break;
      case 3:
        text.insert(at, text.substr(dice.below(text.size()), 4 * length));
        break;
      default:  // mostly still a scene
        if (digit != std::string::npos) text[digit] = static_cast<char>('0' + dice.below(10));
    }
    if (text.empty()) text = "x";
  }
  return text;
}

// How many lines the text has, and how long they are, bounds every place.
void expect_places_in_text(const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics.all()) {
    EXPECT_FALSE(d.message.empty());
    if (!d.span.source || d.span.line == 0) continue;
    const std::string& text = d.span.source->text;
    EXPECT_LE(d.span.line, std::count(text.begin(), text.end(), '\n') + 1);
    EXPECT_GE(d.span.column, 1);
    EXPECT_LE(static_cast<std::size_t>(d.span.column), text.size() + 2);
    EXPECT_GE(d.span.length, 1);
  }
}

TEST(SceneMutations, AreAnsweredWithASceneOrWithErrors) {
  int scenes = 0;
  int refusals = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    Dice dice(seed);
    const std::string text = changed(whole_scene, dice);
    ReadResult read = read_scene_text(text, "mutated.toml", {}, "/nonexistent");
    ResourceCache cache;
    std::optional<Scene> scene;
    if (read.description) scene = compile(*read.description, {}, cache, read.diagnostics);
    ASSERT_EQ(scene.has_value(), !read.diagnostics.has_errors()) << text;
    expect_places_in_text(read.diagnostics);
    ASSERT_TRUE(!scene || !explain(*read.description, *scene, needs_of(*scene)).empty());
    ++(scene ? scenes : refusals);
    ASSERT_FALSE(HasFailure()) << text;
  }
  EXPECT_GT(scenes, 100);
  EXPECT_GT(refusals, 1000);
}

TEST(SceneMutations, TheSceneItselfIsRight) {
  const Scene scene = testing_scenes::compiled(whole_scene);
  EXPECT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.frames.size(), 4U);
}

}  // namespace
}  // namespace backlight
