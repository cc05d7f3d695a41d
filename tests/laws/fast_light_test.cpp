// Lamps and shadows at any γ, against closed forms of one frame.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "rendering.h"
#include "worst.h"

namespace backlight::test {
namespace {

const Vec3 eye{0, 2, -8};

// A floor at y = -1, seen by a camera at rest at time 0, and something at celerity u along x.
std::string floor_and(const std::string& more) {
  return film(60, 40) +
         "[camera]\nposition = [0, 2, -8]\nlook_at = [0, -1, 0]\n"
         "[effects]\ndoppler = false\n"
         "[[object]]\nshape = \"disk\"\nradius = 6\nposition = [0, -1, 0]\n"
         "material = { color = [0.5, 0.5, 0.5] }\n" +
         more;
}

std::string celerity(double u) {
  char text[80];
  std::snprintf(text, sizeof text, "celerity = %.17g\nalong = [1, 0, 0]\n", u);
  return text;
}

class FastLight : public testing::TestWithParam<double> {};

// A ball of such a speed is as thin as a disk, across its motion. It meets the light on its way from the
// lamp, at L, to a point H of the floor at the share s of that way where H.x + s (L.x - H.x) = x0 + v (t - s
// r).
TEST_P(FastLight, AFastBallThrowsTheShadowOfADisk) {
  const double u = GetParam();
  const double v = u / std::sqrt(1.0 + u * u);
  const Vec3 lamp{2, 6, -2}, ball{13.3, 2.5, -1};
  const Rendering r =
      render_text(floor_and("[[light]]\nposition = [2, 6, -2]\nintensity = 60\n"
                            "[[object]]\nshape = \"sphere\"\nradius = 1\nposition = [13.3, 2.5, -1]\n" +
                            celerity(u)));
  int shaded = 0, lit = 0;
  for (int y = 0; y < r.height(); ++y) {
    for (int x = 0; x < r.width(); ++x) {
      if (r.id(x, y) != 1) continue;
      const Vec3 h = r.position(x, y);
      const double time = -glm::length(h - eye);
      const double way = glm::length(lamp - h);
      const double s = (ball.x + v * time - h.x) / (lamp.x - h.x + v * way);
      const Vec3 there = h + s * (lamp - h);
      const double off = std::hypot(there.y - ball.y, there.z - ball.z);
      if (std::abs(off - 1.0) < 1e-3 || std::abs(s) < 1e-3 || std::abs(s - 1.0) < 1e-3) continue;
      const bool dark = s > 0.0 && s < 1.0 && off < 1.0;
      EXPECT_EQ(r.rgb(x, y) == Vec3(0.0), dark) << x << ", " << y;
      ++(dark ? shaded : lit);
    }
  }
  EXPECT_GT(shaded, 30);
  EXPECT_GT(lit, 300);
}

// With R from the lamp's present place to the point, and S² = v² R_x² + R²/γ², the light's way is
// r = γ² (v R_x + S) and D = r/γS, so that (12) is D⁴ cosθ/r² = (v R_x + S) h/(γ² S⁴), h the lamp's height.
TEST_P(FastLight, AFastLampLightsAsItsRetardedFieldDoes) {
  const double u = GetParam();
  const double gamma = std::sqrt(1.0 + u * u);
  const double v = u / gamma;
  const double height = 2.5;
  char text[200];
  std::snprintf(text, sizeof text, "[[light]]\nposition = [%s, 1.5, 0.5]\nintensity = %.17g\n", "7.5",
                gamma * gamma);
  const Rendering r = render_text(floor_and(text + celerity(u)));
  Worst worst;
  for (int y = 0; y < r.height(); ++y) {
    for (int x = 0; x < r.width(); ++x) {
      if (r.id(x, y) != 1) continue;
      const Vec3 h = r.position(x, y);
      const Vec3 now{7.5 - v * glm::length(h - eye), 1.5, 0.5};
      const Vec3 way = h - now;
      if (way.x < 0.5) continue;  // behind it the light is γ⁴ times fainter
      const double s = std::sqrt(v * v * way.x * way.x + glm::dot(way, way) / (gamma * gamma));
      const double expected = 0.5 / std::numbers::pi * (v * way.x + s) * height / (s * s * s * s);
      worst.take(std::abs(r.rgb(x, y).g / expected - 1.0));
    }
  }
  EXPECT_GT(worst.compared, 100);
  EXPECT_LT(worst.error, 3e-6);
}

INSTANTIATE_TEST_SUITE_P(Celerities, FastLight, testing::Values(1e4, 1e6, 1e8, 1e10, 1e12));

}  // namespace
}  // namespace backlight::test
