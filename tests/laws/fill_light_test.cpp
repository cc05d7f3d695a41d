// A light without shadows lights everything as if nothing else were there.
#include <gtest/gtest.h>

#include "rendering.h"

namespace backlight::test {
namespace {

// A ball at 0.8 c past a floor, between it and the lamp.
std::string scene(const std::string& shadows, bool with_ball) {
  const std::string ball =
      "[[object]]\nshape = \"sphere\"\nradius = 0.8\nposition = [5, 1.2, 3.8]\nbeta = [0.5, -0.1, 0.6]\n";
  return film(60, 40) +
         "[camera]\nposition = [0, 3, -8]\nlook_at = [0, 0.5, 0]\nvelocity = [0.1, 0, 0.2]\n"
         "[[light]]\nposition = [2, 6, -2]\nintensity = 60\n" +
         shadows +
         "[[object]]\nname = \"floor\"\nshape = \"disk\"\nradius = 6\n"
         "material = { color = [0.3, 0.6, 0.4], specular = 0.3 }\n" +
         (with_ball ? ball : "");
}

TEST(FillLight, IsNotHidden) {
  for (const RayPath path : {RayPath::sheets, RayPath::one_by_one}) {
    const RenderChoices choices{.path = path};
    const Rendering alone = render_text(scene("", false), choices);
    const Rendering hidden = render_text(scene("", true), choices);
    const Rendering filled = render_text(scene("shadows = false\n", true), choices);
    EXPECT_EQ(filled.statistics.rays.shadow, 0u);
    int floor = 0, shaded = 0;
    for (int y = 0; y < alone.height(); ++y) {
      for (int x = 0; x < alone.width(); ++x) {
        if (filled.id(x, y) != 1) continue;
        ++floor;
        EXPECT_EQ(filled.rgb(x, y), alone.rgb(x, y)) << x << ", " << y;
        if (hidden.rgb(x, y) == alone.rgb(x, y)) continue;
        ++shaded;
        EXPECT_EQ(hidden.rgb(x, y), Vec3(0.0)) << x << ", " << y;
      }
    }
    EXPECT_GT(floor, 400);
    EXPECT_GT(shaded, 20);
  }
}

}  // namespace
}  // namespace backlight::test
