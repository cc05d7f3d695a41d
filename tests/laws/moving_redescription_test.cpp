// The principle of relativity for matter and lamps in motion: docs/physics.md section 5, law 1.
#include <gtest/gtest.h>

#include <cmath>

#include "matter_scenes.h"
#include "redescription.h"

namespace backlight::test {
namespace {

// Of each object the frame and the axes are told by the whole, which is at rest, and the motion by its part:
// so it is the same text in any description.
std::string part(const std::string& keys) {
  return "shape = \"union\"\n[[object.part]]\n" + keys;
}

SceneModel model() {
  SceneModel m = passing_frames(film(64, 48));
  m.objects = {{"ground",
                "shape = \"box\"\nsize = [40, 1, 40]\nmaterial = { color = [0.6, 0.6, 0.5] }",
                {0, -1.5, 8},
                {}},
               {"fair",
                part("shape = \"box\"\nsize = [2, 1, 1.2]\nrotate = [\"10*t\", \"20*t\", 30]\nmaterial = { "
                     "color = [0.7, "
                     "0.2, 0.1], specular = 0.3 }"),
                {0, 0, 0},
                {10, 35, -20}},
               {"ground",
                part("shape = \"cylinder\"\nradius = 0.9\nheight = 1\nrotate = [0, \"45*t\", 0]\nmaterial = "
                     "{ checker = { "
                     "colors = [[0.1, 0.3, 0.8], [0.7, 0.7, 0.7]], size = 0.125 } }"),
                {2.5, 1.2, 1},
                {30, 0, 20}},
               {"ground",
                part("shape = \"sphere\"\nradius = 0.7\nposition = [\"0.7*sin(0.9*t)\", \"0.2*cos(t)\", "
                     "0]\nmaterial = { "
                     "color = [0.8, 0.8, 0.2], emission = 0.1, temperature = 4000 }"),
                {-1.6, 0.3, 0.5},
                {0, 10, 0}}};
  m.lights = {
      {"lamp", "type = \"point\"\nintensity = \"300*(1.5 + sin(2*t))\"\ntemperature = 5000", {0, 0, 0}}};
  return m;
}

void expect_same(const SceneModel& original, const Redescription& other, const std::string& what) {
  const Rendering a = render_text(to_toml(original));
  const Rendering b = render_text(to_toml(other.model));
  const Match m = match(a, b);
  EXPECT_GT(m.seen, 1000) << what;
  EXPECT_EQ(m.other_id, 0) << what;
  EXPECT_LT(m.distance.error, 1e-6) << what;
  EXPECT_LT(m.doppler.error, 1e-6) << what;
  EXPECT_LT(m.own_time.error, 1e-6) << what;
  EXPECT_LT(m.colour.error, 1e-5) << what << m.colour.where;
  int seen = 0;
  for (int y = 1; y < 47; ++y) {
    for (int x = 1; x < 63; ++x) {
      seen |= 1 << a.id(x, y);
      if (a.id(x, y) == 0 || !a.is_inside(x, y) || b.id(x, y) != a.id(x, y)) continue;
      const Mat3& turn = other.rotation_of_object[static_cast<std::size_t>(a.id(x, y) - 1)];
      EXPECT_LT(glm::length(turn * a.position(x, y) - b.position(x, y)),
                1e-6 * (1.0 + glm::length(a.position(x, y))));
      EXPECT_LT(glm::length(turn * a.normal(x, y) - b.normal(x, y)), 1e-6);
    }
  }
  EXPECT_EQ(seen & 0b11110, 0b11110) << "every object should be in view";
}

TEST(MovingRedescription, OneCommonLorentzTransformationChangesNoPixel) {
  for (const double celerity : {0.3, 3.0, 100.0, 1000.0}) {
    for (const Vec3 axis : {Vec3{0.48, -0.6, 0.64}, Vec3{-0.6, 0, -0.8}}) {
      expect_same(model(), redescribed(model(), celerity * axis), digits(celerity));
    }
  }
}

TEST(MovingRedescription, AllOfASceneWithinAFastFrameIsTheSameImage) {
  for (const double celerity : {1.0, 1000.0}) {
    expect_same(model(), within_frame(model(), celerity * Vec3{0.48, -0.6, 0.64}), digits(celerity));
  }
}

// Lamps on paths, rockets and a camera aboard: their directions would turn, and do not where all moves along
// one axis.
TEST(MovingRedescription, OfPathsRocketsAndTravellersAlongTheirAxisChangesNoPixel) {
  const auto scene = [](double celerity) {
    const std::string fast =
        "[frame.outer]\ncelerity = " + digits(celerity) + "\nalong = [0, 0, 1]\norigin = [3, -2, 5]\n";
    const std::string frame = "frame = \"fair\"\n";
    return film(64, 48) + (celerity > 0.0 ? fast : "") + "[frame.fair]\nbeta = [0, 0, 0.4]\n" +
           (celerity > 0.0 ? "within = \"outer\"\n" : "") +
           "[camera]\naboard = \"cart\"\nposition = [0, 0.6, "
           "0]\ndirection = [0, -0.2, 1]\n[[object]]\nname = \"cart\"\nshape = \"box\"\nsize = [1, 1, "
           "1]\nposition = [\"0.4*sin(t)\", "
           "0, \"0.3*t\"]\n" +
           frame +
           "[[object]]\nshape = \"sphere\"\nradius = 1\nposition = [1, 0, 5]\nrocket = { acceleration = 0.2, "
           "along = [1, 2, "
           "3] }\n" +
           frame +
           "[[object]]\nshape = \"box\"\nsize = [2, 2, 2]\nposition = [-2, \"0.2*t\", 6]\nrotate = [0, "
           "\"15*t\", 0]\n" +
           frame + "[[object]]\nshape = \"box\"\nsize = [20, 1, 20]\nposition = [0, -2.5, 8]\n" + frame +
           "[[light]]\nposition = [\"2*cos(0.3*t)\", 4, \"3 + 2*sin(0.3*t)\"]\nintensity = \"60*(1.5 + "
           "sin(3*t))\"\n" +
           frame +
           "[[light]]\nposition = [-3, 2, 2]\nintensity = 30\nrocket = { acceleration = 0.3, along = [0, 1, "
           "1] }\n" +
           frame;
  };
  const Rendering a = render_text(scene(0.0));
  for (const double celerity : {0.5, 20.0, 1000.0}) {
    const Match m = match(a, render_text(scene(celerity)));
    EXPECT_GT(m.seen, 1200);
    EXPECT_EQ(m.other_id, 0) << celerity;
    EXPECT_LT(m.distance.error, 1e-6) << celerity;
    EXPECT_LT(m.doppler.error, 1e-6) << celerity;
    EXPECT_LT(m.own_time.error, 1e-6) << celerity;
    EXPECT_LT(m.position.error, 1e-6) << celerity;
    EXPECT_LT(m.normal.error, 1e-6) << celerity;
    EXPECT_LT(m.colour.error, 1e-5) << celerity << ' ' << m.colour.where;
  }
}

}  // namespace
}  // namespace backlight::test
