// Stereo: two events simultaneous in the camera's frame (docs/physics.md section 2).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "rendering.h"

namespace backlight::test {
namespace {

Vec3 position_of(const Rendering& r, const char* view, int x, int y) {
  const std::string prefix = std::string("P.") + view + ".";
  return {r.at((prefix + "X").c_str(), x, y), r.at((prefix + "Y").c_str(), x, y),
          r.at((prefix + "Z").c_str(), x, y)};
}

TEST(Stereo, EyesAreTheSeparationApartAlongTheCamerasRight) {
  const Rendering r =
      render_text(film(16, 12) +
                  "[camera]\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\nstereo = { separation = 0.5 }\n"
                  "[[object]]\nshape = \"box\"\nsize = [100, 100, 1]\nposition = [0, 0, 6]\n");
  EXPECT_EQ(r.image.layout().views, (std::vector<std::string>{"left", "right"}));
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 16; ++x) {
      const Vec3 difference = position_of(r, "right", x, y) - position_of(r, "left", x, y);
      // right = forward × up = -x
      EXPECT_NEAR(difference.x, -0.5, 1e-5);
      EXPECT_NEAR(difference.y, 0.0, 1e-5);
      EXPECT_NEAR(difference.z, 0.0, 1e-5);
    }
  }
}

// Of a dome, both eyes look at the same place of it, and are apart as everywhere.
TEST(Stereo, EyesUnderADomeAreTheSeparationApart) {
  const Rendering r = render_text(film(16, 16) +
                                  "[camera]\nposition = [0, 0, 0]\ndirection = [0, 1, 0]\nup = [0, 0, 1]\n"
                                  "projection = \"fisheye\"\nfov = 180\nstereo = { separation = 0.5 }\n"
                                  "[[object]]\nshape = \"plane\"\nposition = [0, 6, 0]\n");
  int seen = 0;
  for (int y = 2; y < 14; ++y) {
    for (int x = 2; x < 14; ++x) {
      const Vec3 left = position_of(r, "left", x, y), right = position_of(r, "right", x, y);
      if (left == Vec3{0.0}) continue;
      ++seen;
      // right = forward × up = +x
      EXPECT_LT(glm::length(right - left - Vec3{0.5, 0.0, 0.0}), 2e-5) << x << ' ' << y;
    }
  }
  EXPECT_GT(seen, 80);
}

TEST(Stereo, TheEyesOfAMovingCameraAreApartInItsOwnFrame) {
  // In the world's frame a camera moving along its right has its eyes apart by less, and one ahead in time;
  // what a wall at rest shows under both is where those two past light cones meet it.
  const double gamma = 1.0 / 0.6;  // of v = 0.8
  const Rendering r =
      render_text(film(16, 12) +
                  "[camera]\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\nbeta = [0.8, 0, 0]\nstereo = { "
                  "separation = 0.5 }\n"
                  "[[object]]\nshape = \"box\"\nsize = [1000, 1000, 1]\nposition = [0, 0, 6]\n");
  for (int x = 0; x < 16; x += 3) {
    // Eye event in the camera's frame: (0; ∓0.25 x̂); in the world: (γ v x; γ x).
    const Vec3 left = position_of(r, "left", x, 6);
    const Vec3 right = position_of(r, "right", x, 6);
    // Same null direction from both: the hits differ by the eyes' place only (a wall z = const).
    EXPECT_NEAR(right.x - left.x, -0.5 * gamma, 1e-4);
    EXPECT_NEAR(right.z - left.z, 0.0, 1e-5);
  }
}

TEST(Stereo, PanoramaTurnsTheEyesWithTheHead) {
  const double separation = 0.4;
  const Rendering r =
      render_text(film(32, 16) +
                  "[camera]\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\nprojection = \"equirectangular\"\n"
                  "stereo = { separation = 0.4 }\n[[object]]\nshape = \"sphere\"\nradius = 5\n");
  for (int y = 2; y < 14; y += 3) {
    for (int x = 0; x < 32; x += 3) {
      const double longitude = ((x + 0.5) / 32 - 0.5) * 2.0 * std::numbers::pi;
      const Vec3 aside = std::cos(longitude) * Vec3{-1, 0, 0} - std::sin(longitude) * Vec3{0, 0, 1};
      for (const int eye : {-1, 1}) {
        const char* view = eye < 0 ? "left" : "right";
        const double z = r.at(eye < 0 ? "Z" : "right.Z", x, y);
        const Vec3 expected = 0.5 * eye * separation * aside + z * r.direction(x, y);
        EXPECT_LT(glm::length(position_of(r, view, x, y) - expected), 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace backlight::test
