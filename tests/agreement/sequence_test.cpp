// An image has the same bits whether it is rendered by itself or after others, which leave it what they can.
#include <gtest/gtest.h>

#include "rendering.h"
#include "same_bits.h"

namespace backlight::test {
namespace {

const std::string start = R"toml([film]
resolution = [48, 30]
aovs = ["Z", "P", "N", "objectId"]
[animation]
fps = 4
frames = [1, 5]
[params]
still = "2*0.25"
going = "still + 0.1*image_time"
waving = "0.1*t"
[frame.train]
beta = [0.3, 0, 0.1]
[frame.tram]
beta = ["0.3*min(image_time, 1)", 0, "0.1*min(image_time, 1)"]
[camera]
position = ["0.2*t", 1, -6]
direction = [0, 0, 1]
[[light]]
position = [-4, 6, -6]
intensity = 300
[background]
color = [0.1, 0.2, 0.4]
stars = { count = 500, seed = 2 }
[material.red]
color = [0.8, 0.2, 0.1]
)toml";

std::string sphere_at(double x, double y, const std::string& keys) {
  return "[[object]]\nshape = \"sphere\"\nradius = \"still\"\nposition = [" + std::to_string(x) + ", " +
         std::to_string(y) + ", 0]\n" + keys + "\n";
}

struct Case {
  const char* name;
  std::string objects;
  std::size_t reused;  // surfaces, in each image but the first
  std::size_t made;
  bool materials_reused = true;
};

std::string torus(const std::string& keys) {
  return "[[object]]\nshape = \"torus\"\nmajor = 0.6\nminor = 0.2\n" + keys + "\n";
}

// At frames 4 and 5 t reaches 0.75 and 1: 'tram' moves as 'train' does from frame 5 on.
std::vector<Case> cases() {
  const std::string still = sphere_at(-1, 0, "material = \"red\"") + sphere_at(1, 0, "frame = \"train\"") +
                            sphere_at(0, 1, "beta = [0, 0, 0.4]") + torus("position = [0, -1, 0]");
  return {
      {"nothing changes", still, 4, 0},
      {"frames move, and fall together", still + sphere_at(2, 1, "frame = \"tram\""), 5, 0},
      {"one turns", still + torus("position = [2, 0, 0]\nrotate = [\"90*image_time\", 0, 0]"), 2, 3},
      {"by a parameter", still + torus("position = [\"going\", 2, 0]\nframe = \"train\""), 3, 2},
      {"one gets faster", still + sphere_at(2, 0, "beta = [0, \"0.3*image_time\", 0]"), 4, 1},
      {"more copies",
       still + sphere_at(2, -1,
                         "frame = \"train\"\nrepeat = { count = [\"1 + frame\", 1, 1], step = [0.2, 0, 0] }"),
       3, 5},
      {"a pulse in its own time",
       still + "[[object]]\nshape = \"implicit\"\nf = \"x^2 + y^2 + z^2 - 0.2 - 0.1*sin(3*t)\"\n"
               "bounds = [[-1, -1, -1], [1, 1, 1]]\nposition = [2, 0, 0]\n",
       5, 0},
      {"a pulse by frames",
       still + "[[object]]\nshape = \"implicit\"\nf = \"x^2 + y^2 + z^2 - 0.2 - 0.01*frame\"\n"
               "bounds = [[-1, -1, -1], [1, 1, 1]]\nposition = [2, 0, 0]\n",
       2, 3},
      {"a material within an object",
       still + sphere_at(2, 1, "material = { color = [\"image_time\", 0.5, 0.5] }"), 5, 0, false},
      {"a material by its own time",
       still + sphere_at(2, 1, "material = { color = [\"t\", 0.5, 0.5], emission = \"sin(waving)\" }"), 5, 0},
      {"a solid",
       still + "[[object]]\nshape = \"difference\"\nposition = [2, 0, 0]\n[[object.part]]\nshape = \"box\"\n"
               "size = [1, 1, 1]\n[[object.part]]\nshape = \"sphere\"\nradius = \"0.5 + 0.1*image_time\"\n"
               "material = { color = [0.1, 0.9, 0.2] }\n",
       2, 3},
  };
}

TEST(Sequence, HasTheBitsOfItsImagesAlone) {
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    const std::string text = start + one.objects;
    const std::vector<int> frames{1, 3, 5, 2};
    const std::vector<Rendering> together = render_sequence(text, frames);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      SCOPED_TRACE(frames[i]);
      const Rendering alone = render_text(text, {.frame = frames[i]});
      expect_same_bits(alone.image, together[i].image);
      EXPECT_EQ(alone.scene.counts.surfaces_reused, 0U);
      EXPECT_EQ(alone.scene.counts.materials_reused, 0U);
    }
  }
}

TEST(Sequence, MakesOnceWhatDoesNotDependOnTime) {
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    const std::vector<Rendering> images = render_sequence(start + one.objects, {2, 3});
    const CompileCounts& first = images[0].scene.counts;
    const CompileCounts& second = images[1].scene.counts;
    EXPECT_EQ(first.surfaces_reused, 0U);
    EXPECT_EQ(second.surfaces_reused, one.reused);
    EXPECT_EQ(second.surfaces_made, one.made);
    EXPECT_EQ(second.materials_reused, one.materials_reused ? first.materials_made : 0U);
    EXPECT_EQ(second.materials_made, one.materials_reused ? 0U : first.materials_made);
  }
}

// What two frames that have become equal hold is one set of surfaces, made for that image.
TEST(Sequence, JoinsFramesThatBecomeEqual) {
  const std::string text =
      start + sphere_at(1, 0, "frame = \"train\"") + sphere_at(-1, 0, "frame = \"tram\"");
  const std::vector<Rendering> images = render_sequence(text, {4, 5, 5});
  EXPECT_EQ(images[0].scene.frames.size(), 3U);
  EXPECT_EQ(images[1].scene.frames.size(), 2U);
  EXPECT_EQ(images[1].scene.counts.surfaces_made, 2U);
  EXPECT_EQ(images[2].scene.counts.surfaces_reused, 2U);
}

}  // namespace
}  // namespace backlight::test
