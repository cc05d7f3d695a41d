// Dark colours after a shift, and the levels `uv` and `ir`, on rendered images: docs/colour.md, "Bounds".
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "backlight/film/png.h"
#include "rendering.h"

namespace backlight::test {
namespace {

// A wall that fills the picture and moves with its lamp, seen along the motion or across it.
Vec3 wall(const std::string& material, const std::string& beta, const std::string& lamp = "") {
  return render_text(
             film(8, 6) + "[camera]\nposition = [0, 0, 0]\nfov = 20\n[frame.wall]\nbeta = " + beta +
             "\n[[object]]\nshape = \"disk\"\nradius = 400\nposition = [0, 0, 60]\nrotate = [90, 0, 0]\n" +
             "frame = \"wall\"\nmaterial = { " + material + " }\n[[light]]\ntype = \"distant\"\n" +
             "direction = [0, 0, 1]\nirradiance = 3\nframe = \"wall\"\n" + lamp)
      .rgb(4, 3);
}

const std::vector<std::string> motions{"[0, 0, -0.2]", "[0, 0, 0.2]", "[0, 0, -0.6]",
                                       "[0, 0, 0.5]",  "[0.6, 0, 0]", "[0.3, 0.2, -0.3]"};

TEST(DarkColours, NeverOutshineTheirShareOfWhitePaper) {
  for (const std::string& beta : motions) {
    for (const char* lamp : {"", "temperature = 2000\n", "temperature = 20000\n"}) {
      const Vec3 paper = xyz_from_rgb(wall("color = [1, 1, 1]", beta, lamp));
      for (const Vec3& rgb : {Vec3{0.02, 0, 0.02},
                              {0.02, 0, 0},
                              {0, 0, 0.02},
                              {0, 0.02, 0.02},
                              {0.2, 0, 0.1},
                              {0.001, 0, 0.001},
                              {0.3, 0.01, 0.3}}) {
        const std::string colour = "color = [" + std::to_string(rgb.r) + ", " + std::to_string(rgb.g) + ", " +
                                   std::to_string(rgb.b) + "]";
        const Vec3 seen = xyz_from_rgb(wall(colour, beta, lamp));
        const double share = 2.0 * std::max({rgb.r, rgb.g, rgb.b});
        for (int k = 0; k < 3; ++k) {
          EXPECT_LE(seen[k], share * paper[k] * (1.0 + 1e-4)) << colour << " " << beta << " " << lamp << k;
          EXPECT_GE(seen[k], -1e-4 * paper[k]);
        }
      }
    }
  }
}

// The case that was seen: no channel of a dark purple is brighter than paper's, at any of these speeds.
TEST(DarkColours, ADarkPurpleIsDarkerThanPaperInEveryChannel) {
  for (double beta = -0.9; beta < 0.95; beta += 0.1) {
    const std::string along = "[0, 0, " + std::to_string(beta) + "]";
    const Vec3 paper = wall("color = [1, 1, 1]", along);
    const Vec3 purple = wall("color = [0.02, 0, 0.02]", along);
    for (int c = 0; c < 3; ++c)
      EXPECT_LT(purple[c], 0.1 * std::max(paper[c], 0.1 * luminance(paper))) << along << " " << c;
  }
}

// What is shown of a colour at rest is the colour.
TEST(DarkColours, AreThemselvesAtRest) {
  for (const Vec3& rgb : {Vec3{0.02, 0, 0.02}, {0.5, 0.0, 0.25}, {0.98, 1, 0.97}}) {
    const std::string colour = "color = [" + std::to_string(rgb.r) + ", " + std::to_string(rgb.g) + ", " +
                               std::to_string(rgb.b) + "]";
    const Vec3 seen = wall(colour, "[0, 0, 0]") / wall("color = [1, 1, 1]", "[0, 0, 0]");
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], rgb[c], 1e-6);
  }
}

TEST(Levels, HaveAnEffectForEveryColour) {
  const std::string texture = std::string(BACKLIGHT_BINARY_DIR) + "/dark_texel.png";
  ASSERT_TRUE(write_png(texture, PixelBytes{1, 1, 3, {60, 20, 60}}).ok());
  const std::string of_texture = "texture = \"" + texture + "\"";
  for (const std::string& colour :
       {std::string("color = [0.02, 0, 0.02]"), std::string("color = [0, 0, 0]"),
        std::string("color = [1, 1, 1]"), std::string("color = [0.2, 0.2, 0.2]"),
        std::string("color = [0.9, 0.1, 0.1]"),
        std::string("checker = { colors = [[0.3, 0.3, 0.3], [0.02, 0, 0.02]], size = 1e-6 }"), of_texture}) {
    for (const char* receding : {"[0, 0, 0.2]", "[0, 0, 0.5]", "[0.6, 0, 0.4]"}) {
      const Vec3 low = wall(colour + ", uv = 0", receding);
      const Vec3 high = wall(colour + ", uv = 1", receding);
      EXPECT_GT(high.b, low.b + 1e-4 * std::abs(high.b)) << colour << receding;
    }
    for (const char* coming : {"[0, 0, -0.2]", "[0, 0, -0.5]", "[0.2, 0, -0.4]"}) {
      const Vec3 low = wall(colour + ", ir = 0", coming);
      const Vec3 high = wall(colour + ", ir = 1", coming);
      EXPECT_GT(high.r, low.r + 1e-4 * std::abs(high.r)) << colour << coming;
    }
  }
}

}  // namespace
}  // namespace backlight::test
