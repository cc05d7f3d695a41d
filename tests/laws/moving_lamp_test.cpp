// Lamps on paths, and the shadows of and on matter in motion: docs/physics.md section 13.
#include <gtest/gtest.h>

#include <cmath>

#include "matter_scenes.h"

namespace backlight::test {
namespace {

// A street with things at rest, one that passes and one that turns.
std::string street(const std::string& aovs, const std::string& camera_motion) {
  return "[film]\nresolution = [64, 48]\naovs = [" + aovs +
         "]\n[camera]\nposition = [0, 2, -7]\nlook_at = [0, 0.6, 0]\nfov = 60\n" + camera_motion +
         "[frame.passing]\nbeta = [0.5, 0.1, 0.3]\norigin = [2, 1, 3]\n"
         "[[object]]\nshape = \"box\"\nsize = [30, 0.5, 30]\nposition = [0, -0.25, 5]\nmaterial = { checker "
         "= { colors = "
         "[[0.8, 0.8, 0.8], [0.3, 0.2, 0.2]], size = 0.1 } }\n"
         "[[object]]\nshape = \"sphere\"\nradius = 0.8\nposition = [-1.5, 1, 1]\nmaterial = { color = [0.2, "
         "0.4, 0.8], "
         "specular = 0.5, shininess = 20 }\n"
         "[[object]]\nshape = \"box\"\nsize = [1, 1, 1]\nframe = \"passing\"\nmaterial = { color = [0.8, "
         "0.4, 0.2] }\n"
         "[[object]]\nshape = \"box\"\nsize = [1.2, 0.4, 0.9]\nposition = [0.8, 0.9, -1]\nrotate = [20, "
         "\"35*t\", "
         "\"20*sin(t)\"]\nmaterial = { color = [0.4, 0.8, 0.3] }\n";
}

const char* const all_aovs =
    "\"Z\", \"doppler\", \"emissionTime\", \"properTime\", \"P\", \"N\", \"objectId\", \"light\"";

class LampOfConstantVelocity : public testing::TestWithParam<double> {};

TEST_P(LampOfConstantVelocity, LightsAsTheInertialLampDoes) {
  const Vec3 v = Oblique{GetParam(), 20.0, -10.0}.velocity();
  // Its light of the place (-2, 3.5, -2) reaches the middle of the street when that is seen.
  const Vec3 place = Vec3{-2, 3.5, -2} + 11.0 * v;
  const std::string light = "[[light]]\nintensity = \"" + digits(60.0 / lorentz_factor(v)) +
                            "*(1.5 + sin(2*t))\"\ntemperature = 5000\n";
  for (const char* camera : {"", "beta = [0.2, -0.1, 0.5]\n"}) {
    const Rendering a = render_text(street(all_aovs, camera) + light + path(place, v));
    const Rendering b = render_text(street(all_aovs, camera) + light + "position = " + list(place) +
                                    "\nbeta = " + list(v) + "\n");
    const Match m = match(a, b, Pixels::all);
    EXPECT_GT(m.seen, 1500);
    EXPECT_LT(m.colour.error, 2e-5) << m.colour.where;
    int dark = 0;
    int lit = 0;
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) {
        EXPECT_EQ(a.at("light.N", x, y), b.at("light.N", x, y)) << x << ' ' << y;
        (a.at("light.N", x, y) == 0.0 ? dark : lit) += a.id(x, y) == 1 ? 1 : 0;
      }
    }
    EXPECT_GT(dark, 20) << "nothing throws a shadow on the street";
    EXPECT_GT(lit, 300);
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, LampOfConstantVelocity, testing::Values(0.02, 0.5, 0.9, 0.999));

// In a frame of its own a path is told in that frame's coordinates and time.
TEST(MovingLamp, InAMovingFrameAddsUpItsVelocities) {
  // 0.5 and 0.4 along the same direction are 0.75.
  const Vec3 n = glm::normalize(Vec3{0.5, 0.1, 0.3});
  const std::string light = "[[light]]\nintensity = \"60*(1.5 + sin(2*t))\"\n";
  const std::string frame = "[frame.fast]\nbeta = " + list(0.5 * n) + "\norigin = [-2, 3, -2]\n";
  const std::string camera = "";
  const Rendering a =
      render_text(street(all_aovs, camera) + frame + light + "frame = \"fast\"\n" + path({0, 0, 0}, 0.4 * n));
  const Rendering b = render_text(street(all_aovs, camera) + light +
                                  "position = [-2, 3, -2]\nbeta = " + list(0.75 * n) + "\n");
  const Match m = match(a, b, Pixels::all);
  EXPECT_GT(m.seen, 1500);
  EXPECT_LT(m.colour.error, 2e-5) << m.colour.where;
}

TEST(MovingLamp, ThatStandsStillByItsFormulaIsTheLampAtRest) {
  const std::string light = "[[light]]\nintensity = \"60*(1.5 + sin(2*t))\"\n";
  const Rendering a =
      render_text(street(all_aovs, "") + light + "position = [\"-2 + 0*sin(t)\", 3.5, \"-2 + t - t\"]\n");
  const Rendering b = render_text(street(all_aovs, "") + light + "position = [-2, 3.5, -2]\n");
  const Match m = match(a, b, Pixels::all);
  EXPECT_GT(m.seen, 1500);
  EXPECT_LT(m.colour.error, 2e-5) << m.colour.where;
}

// A rocket's lamp is at √(1/a² + t²) - 1/a along its thrust.
TEST(MovingLamp, OfARocketIsTheLampOnTheHyperbola) {
  const std::string light = "[[light]]\nintensity = \"60*(1.5 + sin(2*t))\"\n";
  const Rendering a =
      render_text(street(all_aovs, "") + light +
                  "position = [-1, 3, -2]\nrocket = { acceleration = 0.5, along = [0, 0, 3] }\n");
  const Rendering b =
      render_text(street(all_aovs, "") + light + "position = [-1, 3, \"-2 + sqrt(4 + t^2) - 2\"]\n");
  const Match m = match(a, b, Pixels::all);
  EXPECT_GT(m.seen, 1500);
  EXPECT_LT(m.colour.error, 2e-5) << m.colour.where;
}

// A lamp on a circle about what it lights is seen by all of it at its clock's rate alone, and there it is as
// bright as its irradiance D⁴ I/r² with D = √(1 - v²): transverse.
TEST(MovingLamp, OnACircleLightsItsCentreByItsClock) {
  for (const double v : {0.3, 0.8}) {
    // A small disk at the centre of a circle of radius 2 in the plane z = -1 above it... seen from above.
    const double w = v / 2.0;
    const std::string scene =
        "[film]\nresolution = [3, 3]\n[camera]\nposition = [0, 0, -5]\nfov = 0.001\n[effects]\ndoppler = "
        "false\n"
        "[[object]]\nshape = \"disk\"\nradius = 1\nrotate = [90, 0, 0]\nmaterial = { color = [1, 1, 1] "
        "}\n[[light]]\n"
        "intensity = \"7*(1.2 + sin(3*t))\"\nposition = [\"2*cos(" +
        digits(w) + "*t)\", \"2*sin(" + digits(w) + "*t)\", -1.5]\n";
    for (const double time : {0.0, 1.3, 9.7}) {
      RenderChoices at;
      at.time = time;
      const double rate = std::sqrt(1.0 - v * v);
      const double own = rate * (time - 5.0 - 2.5);
      const double irradiance = std::pow(rate, 4) * 7.0 * (1.2 + std::sin(3.0 * own)) * (1.5 / 2.5) / 6.25;
      // The film's Y = E/π; white light on a white surface.
      EXPECT_NEAR(render_text(scene, at).rgb(1, 1).g * 3.14159265358979 / irradiance, 1.0, 1e-4)
          << v << ' ' << time;
    }
  }
}

}  // namespace
}  // namespace backlight::test
