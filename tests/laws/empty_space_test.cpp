// What the channels say where a ray meets nothing: alpha, Z and the others.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rendering.h"

namespace backlight::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A glowing ball before a camera, in the middle of the picture.
std::string ball(const std::string& background, const std::string& more_film = "") {
  return film(40, 30) + more_film +
         "[camera]\nposition = [0, 0, -5]\nbeta = [0.05, 0, 0.2]\n[[object]]\nshape = \"sphere\"\nradius = "
         "1\n"
         "material = { color = [0, 0, 0], emission = 2 }\n" +
         background;
}

void expect_empty_corner(const Rendering& picture, double alpha) {
  EXPECT_EQ(picture.at("A", 0, 0), alpha);
  EXPECT_EQ(picture.at("Z", 0, 0), infinity);
  for (const char* channel :
       {"emissionTime.T", "properTime.T", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "objectId.V"}) {
    EXPECT_EQ(picture.at(channel, 0, 0), 0.0) << channel;
  }
  EXPECT_EQ(picture.statistics.rays.non_finite, 0U);
}

class EmptySpace : public testing::TestWithParam<RayPath> {
 protected:
  [[nodiscard]] static Rendering rendered(const std::string& text) {
    RenderChoices choices;
    choices.path = GetParam();
    return render_text(text, choices);
  }
};

INSTANTIATE_TEST_SUITE_P(ByEveryPath, EmptySpace, testing::Values(RayPath::sheets, RayPath::one_by_one));

TEST_P(EmptySpace, IsTransparentWithoutABackground) {
  const Rendering picture = rendered(ball(""));
  expect_empty_corner(picture, 0.0);
  EXPECT_EQ(picture.rgb(0, 0), Vec3(0.0));
  EXPECT_GT(picture.at("doppler.D", 0, 0), 0.0);  // of the frame in which a sky would be at rest
  int seen = 0;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      const bool is_ball = picture.id(x, y) == 1;
      EXPECT_EQ(picture.at("A", x, y), is_ball ? 1.0 : 0.0);
      EXPECT_EQ(std::isfinite(picture.at("Z", x, y)), is_ball);
      seen += is_ball ? 1 : 0;
    }
  }
  EXPECT_GT(seen, 30);
}

TEST_P(EmptySpace, IsOpaqueWithAnyBackground) {
  for (const char* background :
       {"[background]\ncolor = [0.1, 0.2, 0.3]\n", "[background]\ncolor = [0, 0, 0]\n",
        "[background]\ntemperature = 300\n", "[background]\ncolor = [1, 1, 1]\nradiance = 0\n",
        "[background]\nstars = { count = 9 }\n"}) {
    SCOPED_TRACE(background);
    expect_empty_corner(rendered(ball(background)), 1.0);
  }
  // One that only says how it would move is none.
  expect_empty_corner(rendered(ball("[background]\nbeta = [0.5, 0, 0]\n")), 0.0);
}

// Alpha is the share of the samples that met something, and the colour is multiplied by it: the glowing
// ball's colour is the same everywhere, so they are proportional.
TEST_P(EmptySpace, MakesEdgesPremultiplied) {
  std::string text = ball("");
  text.replace(text.find("samples = 1"), 11, "samples = 16");
  text.replace(text.find("beta = [0.05, 0, 0.2]"), 21, "beta = [0, 0, 0]");
  const Rendering picture = rendered(text);
  const Vec3 inside = picture.rgb(20, 15);
  int edges = 0;
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      const double alpha = picture.at("A", x, y);
      edges += alpha > 0.0 && alpha < 1.0 ? 1 : 0;
      EXPECT_EQ(16.0 * alpha, std::round(16.0 * alpha));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(picture.rgb(x, y)[c], alpha * inside[c], 1e-5 * inside[c]);
    }
  }
  EXPECT_GT(edges, 10);
}

// Where a tolerance chooses the samples.
TEST_P(EmptySpace, IsTransparentAtAToleranceToo) {
  std::string text = ball("");
  text.replace(text.find("samples = 1"), 11, "tolerance = 0.01");
  const Rendering picture = rendered(text);
  expect_empty_corner(picture, 0.0);
  EXPECT_EQ(picture.at("A", 20, 15), 1.0);
}

// Both eyes, and beyond the circle of a fisheye, where there is no ray at all.
TEST_P(EmptySpace, IsTheSameForEveryProjection) {
  const std::string circle = "projection = \"fisheye\"\nfov = 90\n";
  std::string text = ball("[background]\ncolor = [1, 1, 1]\n");
  text.insert(text.find("position"), circle);
  const Rendering fisheye = rendered(text);
  expect_empty_corner(fisheye, 0.0);  // no ray: not even the background is there
  EXPECT_EQ(fisheye.at("A", 20, 1), 1.0);
  for (const std::string projection : {"perspective", "equirectangular"}) {
    std::string pair = ball("");
    pair.insert(pair.find("position"),
                "projection = \"" + projection + "\"\nstereo = { separation = 0.1 }\n");
    const Rendering stereo = rendered(pair);
    for (const char* alpha : {"A", "right.A"}) EXPECT_EQ(stereo.at(alpha, 0, 0), 0.0);
    for (const char* z : {"Z", "right.Z"}) EXPECT_EQ(stereo.at(z, 0, 0), infinity);
    for (const char* alpha : {"A", "right.A"}) EXPECT_EQ(stereo.at(alpha, 20, 15), 1.0);
  }
}

}  // namespace
}  // namespace backlight::test
