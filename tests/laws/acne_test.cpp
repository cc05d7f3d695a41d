// No surface shadows itself by rounding, at any speed or distance.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "rendering.h"

namespace backlight::test {
namespace {

struct Case {
  const char* name;
  double gamma;
  Vec3 along;
  double distance;  ///< light-travel distance, in the camera's frame, at which the body is seen
};

class Acne : public testing::TestWithParam<Case> {};

// The body's frame has its origin at the event that the camera, at the world's origin at time 0, sees
// straight ahead. One convex body with a lamp at rest beside it: whatever faces the lamp must be lit.
std::string scene(const Case& c, const char* shape) {
  std::ostringstream s;
  s.precision(17);
  s << film(64, 48) << "[effects]\ndoppler = false\nsearchlight = \"off\"\n"
    << "[camera]\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\nfov = " << std::min(100.0, 140.0 / c.distance)
    << "\n"
    << "[frame.body]\norigin = [0, 0, " << c.distance << "]\norigin_time = " << -c.distance << "\n";
  if (c.gamma > 1.0)
    s << "gamma = " << c.gamma << "\nalong = [" << c.along.x << ", " << c.along.y << ", " << c.along.z
      << "]\n";
  s << "[[light]]\nframe = \"body\"\nposition = [7, 11, -9]\nintensity = 1000\n"
    << "[[object]]\nframe = \"body\"\nrotate = [20, 30, 10]\nmaterial = { color = [1, 1, 1] }\n"
    << shape;
  return s.str();
}

TEST_P(Acne, AConvexBodyNeverShadowsItself) {
  int lit = 0;
  for (const char* shape :
       {"shape = \"sphere\"\nradius = 1\n", "shape = \"box\"\nsize = [1.5, 1.2, 1.1]\n",
        "shape = \"cylinder\"\nradius = 0.8\nheight = 1.5\n", "shape = \"cone\"\nradius = 1\nheight = 1.5\n",
        "shape = \"quadric\"\ncoefficients = [1, 2, 3, 0, 0, 0, 0, 0, 0, -1]\n"}) {
    const Rendering r = render_text(scene(GetParam(), shape));
    for (int y = 0; y < r.height(); ++y) {
      for (int x = 0; x < r.width(); ++x) {
        if (r.id(x, y) != 1) continue;
        const Vec3 to_lamp = Vec3{7, 11, -9} - r.position(x, y);
        const double cosine = glm::dot(r.normal(x, y), to_lamp) / glm::length(to_lamp);
        const double expected = std::max(cosine, 0.0) * 1000 / (M_PI * glm::dot(to_lamp, to_lamp));
        EXPECT_NEAR(r.rgb(x, y).g, expected, 1e-5) << shape << " at " << x << ' ' << y;
        lit += cosine > 0.0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(lit, 300);
}

INSTANTIATE_TEST_SUITE_P(SpeedsAndDistances, Acne,
                         testing::Values(Case{"rest", 1.0, {1, 0, 0}, 5}, Case{"far", 1.0, {1, 0, 0}, 1e6},
                                         Case{"oblique_2", 2.0, {1, 0.3, -0.5}, 5},
                                         Case{"passing_100", 100.0, {1, 0, 0.2}, 5},
                                         Case{"receding_100", 100.0, {0.1, 0, 1}, 5},
                                         Case{"approaching_100", 100.0, {0.1, 0, -1}, 500},
                                         Case{"passing_million", 1e6, {1, 0.2, 0}, 5},
                                         Case{"receding_million", 1e6, {0.3, 0.1, 1}, 5}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace backlight::test
