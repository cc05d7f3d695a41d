// Off-axis perspectives and cubemaps on rendered images.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "rendering.h"

namespace backlight::test {
namespace {

// Behind a pixel's centre on the wall, the eye sees that very point of a glass that hangs there.
TEST(Screen, PixelsAreWhereTheyAreOnTheWall) {
  const Vec3 lower_left{1.0, 0.0, 4.5}, across{-3.0, 0.0, -1.5}, upward{0.0, 2.0, 0.0};
  for (const char* velocity : {"", "velocity = [0.3, 0.1, 0.5]\n"}) {
    const Rendering r = render_text(
        film(24, 20) + "[camera]\nposition = [0.7, 0.4, -1]\n" + velocity +
        "screen = { lower_left = [1, 0, 4.5], lower_right = [-2, 0, 3], upper_left = [1, 2, 4.5] }\n"
        "[[object]]\nshape = \"sphere\"\nradius = 50\n");
    const Vec3 eye{0.7, 0.4, -1.0};
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 24; ++x) {
        const Vec3 place = lower_left + (x + 0.5) / 24.0 * across + (1.0 - (y + 0.5) / 20.0) * upward;
        const Vec3 expected = glm::normalize(place - eye);
        EXPECT_LT(glm::length(r.direction(x, y) - expected), 1e-14) << x << ", " << y;
      }
    }
  }
}

// An eye anywhere in a room of six screens sees all around: they take up the whole sphere, and where two
// walls meet their pictures do.
TEST(Screen, SixWallsHaveNoSeam) {
  const char* const walls[6] = {
      "lower_left = [2, -1, 3], lower_right = [-2, -1, 3], upper_left = [2, 2, 3]",
      "lower_left = [-2, -1, -3], lower_right = [2, -1, -3], upper_left = [-2, 2, -3]",
      "lower_left = [2, -1, -3], lower_right = [2, -1, 3], upper_left = [2, 2, -3]",
      "lower_left = [-2, -1, 3], lower_right = [-2, -1, -3], upper_left = [-2, 2, 3]",
      "lower_left = [2, 2, 3], lower_right = [-2, 2, 3], upper_left = [2, 2, -3]",
      "lower_left = [2, -1, -3], lower_right = [-2, -1, -3], upper_left = [2, -1, 3]"};
  double sum = 0.0;
  std::vector<Lens> lenses;
  for (const char* wall : walls) {
    const Rendering r =
        render_text(film(60, 60) + "[camera]\nposition = [-0.7, 0.4, 1.1]\nscreen = { " + wall + " }\n");
    lenses.push_back(r.scene.camera.lens);
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 60; ++x) sum += pixel_solid_angle(lenses.back(), {x + 0.5, y + 0.5});
    }
  }
  EXPECT_NEAR(sum, 4.0 * std::numbers::pi, 5e-3);
  for (int y = 0; y <= 60; y += 5) {  // the front wall's right edge is the next one's left
    const Vec3 front = *direction_at(lenses[0], {60.0, double(y)});
    const Vec3 aside = *direction_at(lenses[3], {0.0, double(y)});
    EXPECT_LT(glm::length(front - aside), 1e-14) << y;
  }
}

// What a cubemap shows on a face is what a perspective of 90 degrees shows that looks there, to rounding.
TEST(Cubemap, FacesAreTheImagesOfSixCameras) {
  const std::string things =
      "velocity = [0.3, -0.1, 0.4]\n[background]\ncolor = [0.1, 0.2, 0.3]\n[[light]]\nposition = [3, 5, -2]\n"
      "intensity = 90\n[[object]]\nshape = \"sphere\"\nradius = 1\nposition = [3, 0, 1]\nbeta = [0.2, 0.5, "
      "0]\n"
      "[[object]]\nshape = \"box\"\nposition = [-2, 1, 4]\nsize = [1, 2, 1]\n"
      "[[object]]\nshape = \"plane\"\nposition = [0, -1, 0]\n";
  const Rendering cube = render_text(film(72, 48) + "[camera]\nprojection = \"cubemap\"\n" + things);
  const char* const cameras[6] = {"direction = [-1, 0, 0]\n",
                                  "direction = [1, 0, 0]\n",
                                  "direction = [0, 1, 0]\nup = [0, 0, -1]\n",
                                  "direction = [0, -1, 0]\nup = [0, 0, 1]\n",
                                  "direction = [0, 0, 1]\n",
                                  "direction = [0, 0, -1]\n"};
  for (int face = 0; face < 6; ++face) {
    const Rendering one = render_text(film(24, 24) + "[camera]\nfov = 90\n" + cameras[face] + things);
    for (int y = 0; y < 24; ++y) {
      for (int x = 0; x < 24; ++x) {
        const int column = 24 * (face % 3) + x, row = 24 * (face / 3) + y;
        ASSERT_EQ(cube.id(column, row), one.id(x, y)) << face << ": " << x << ", " << y;
        ASSERT_LT(glm::length(cube.direction(column, row) - one.direction(x, y)), 1e-15);
        ASSERT_LT(glm::length(cube.rgb(column, row) - one.rgb(x, y)),
                  2e-3 * (1.0 + glm::length(one.rgb(x, y))));
      }
    }
  }
}

}  // namespace
}  // namespace backlight::test
