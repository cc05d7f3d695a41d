// Solids, blends, flows and things that come and go, in motion: docs/physics.md section 13.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "matter_scenes.h"

namespace backlight::test {
namespace {

std::string stage() {
  return film(64, 48) +
         "[camera]\nposition = [0, 1.5, -7]\nlook_at = [0, 0.4, 0]\nfov = 45\nbeta = [0.1, 0, 0.3]\ntime = "
         "0.3\n"
         "[[light]]\nposition = [3, 6, -3]\nintensity = 90\n[[light]]\nposition = [-4, 3, -2]\nbeta = [0.5, "
         "0, "
         "0.2]\nintensity = 40\n"
         "[[object]]\nshape = \"box\"\nsize = [20, 0.5, 20]\nposition = [0, -1.5, 4]\n";
}

const char* const ball = "shape = \"sphere\"\nradius = 0.8\nmaterial = { color = [0.8, 0.2, 0.2] }\n";
const char* const block = "shape = \"box\"\nsize = [2.5, 0.7, 1.2]\nmaterial = { color = [0.2, 0.6, 0.3] }\n";
const char* const swing =
    "position = [\"0.6*sin(0.7*t)\", 0.3, \"0.2*cos(0.7*t)\"]\nrotate = [0, \"20*t\", \"15*sin(t)\"]\n";

// The outside of a union is that of its parts, wherever they go: also its shadows.
TEST(MovingSolids, AUnionOfMovingPartsLooksAsTheyDoOneByOne) {
  const std::string apart = std::string("[[object]]\n") + block + "[[object]]\n" + ball + swing;
  const std::string together = std::string("[[object]]\nshape = \"union\"\n[[object.part]]\n") + block +
                               "[[object.part]]\n" + ball + swing;
  const Rendering a = render_text(stage() + apart);
  const Rendering b = render_text(stage() + together);
  int seen[4] = {};
  for (int y = 1; y < 47; ++y) {
    for (int x = 1; x < 63; ++x) {
      const int id = a.id(x, y);
      ++seen[id];
      if (!a.is_inside(x, y)) continue;
      ASSERT_EQ(b.id(x, y), std::min(id, 2)) << x << ' ' << y;
      if (id == 0) continue;
      for (const char* channel :
           {"Z", "doppler.D", "emissionTime.T", "properTime.T", "N.X", "N.Y", "N.Z", "P.X", "P.Z"}) {
        EXPECT_NEAR(a.at(channel, x, y), b.at(channel, x, y), 1e-5) << channel << ' ' << x << ' ' << y;
      }
      EXPECT_LT(glm::length(a.rgb(x, y) - b.rgb(x, y)), 1e-5 * glm::length(a.rgb(x, y))) << x << ' ' << y;
    }
  }
  EXPECT_GT(seen[2], 60);
  EXPECT_GT(seen[3], 100);
}

// A whole that moves with all its parts, or each of them with the whole's motion.
TEST(MovingSolids, TheMotionOfAWholeIsThatOfEachOfItsParts) {
  const std::string path = "position = [\"0.5*sin(0.8*t)\", \"0.3*cos(t)\", 0.2]\n";
  const auto solid = [&](const std::string& shape, const std::string& whole, const std::string& part) {
    return "[[object]]\nshape = \"" + shape + "\"\n" + whole + "[[object.part]]\n" + block + part +
           "[[object.part]]\nshape = \"sphere\"\nradius = 0.6\nmaterial = { color = [0.3, 0.3, 0.9] }\n" +
           part;
  };
  for (const std::string shape : {"union", "difference", "intersection"}) {
    expect_same(
        match(render_text(stage() + solid(shape, path, "")), render_text(stage() + solid(shape, "", path))),
        shape);
  }
}

// The wall that a moving tool leaves is the tool's matter.
TEST(MovingSolids, AHoleHasTheVelocityOfTheToolThatMakesIt) {
  const std::string text =
      std::string("[[object]]\nshape = \"difference\"\n[[object.part]]\n") + block +
      "[[object.part]]\nshape = \"cylinder\"\nradius = 0.5\nheight = 3\nrotate = [90, 0, "
      "0]\nposition = [\"0.6*sin(0.9*t)\", 0, 0]\n";
  const Rendering r = render_text(stage() + text);
  int walls = 0;
  for (int y = 1; y < 47; ++y) {
    for (int x = 1; x < 63; ++x) {
      if (r.id(x, y) != 2) continue;
      const double t = r.at("emissionTime.T", x, y);
      const Vec3 p = r.position(x, y);
      const double away = std::hypot(p.x - 0.6 * std::sin(0.9 * t), p.y);
      const bool wall = std::abs(away - 0.5) < 1e-5 && std::abs(std::abs(p.z) - 0.6) > 1e-4;
      walls += wall ? 1 : 0;
      const double own = r.at("properTime.T", x, y);
      // γ is 1 exactly where nothing moves.
      if (!wall) {
        EXPECT_NEAR(own, t, 1e-6 * std::abs(t));
      } else {
        EXPECT_LT(std::abs(own), std::abs(t) * 0.99);
      }
    }
  }
  EXPECT_GT(walls, 20);
}

// A flow of matter that is that of a rigid motion is that motion: of a body that turns, and of one that goes.
TEST(MatterVelocity, OfARigidMotionIsThatOfTheBody) {
  const double w = 0.5;
  const std::string shape = "x^4 + 2*y^4 + z^4 - 0.5*x*z - 0.6";
  const auto implicit = [](const std::string& f, const std::string& more) {
    return "[[object]]\nshape = \"implicit\"\nf = \"" + f + "\"\n" + more;
  };
  const std::string cs = "cos(0.5*t)", sn = "sin(0.5*t)";
  const std::string x = "(x*" + cs + " - z*" + sn + ")", z = "(x*" + sn + " + z*" + cs + ")";
  const std::string flow =
      implicit(x + "^4 + 2*y^4 + " + z + "^4 - 0.5*" + x + "*" + z + " - 0.6",
               "bounds = [[-1.3, -1.3, -1.3], [1.3, 1.3, 1.3]]\nmatter_velocity = [\"0.5*z\", \"0\", "
               "\"-0.5*x\"]\n");
  const std::string rotate = "rotate = [0, \"" + digits(w * 180.0 / std::numbers::pi) + "*t\", 0]\n";
  const std::string turned = implicit(shape, rotate);
  expect_same(match(render_text(stage() + turned), render_text(stage() + flow)), "turning");
  // Within a body that goes its own way, the velocities in it come on top.
  const std::string round = "x^2 + 2*y^2 + z^2 - 1";
  const std::string way = "position = [\"0.3*sin(t)\", 0.1, \"0.1*t\"]\nscale = [1, 0.9, 1]\n";
  const std::string bounded = "bounds = [[-1.3, -1.3, -1.3], [1.3, 1.3, 1.3]]\n";
  const std::string whirl = "matter_velocity = [\"0.5*z\", \"0\", \"-0.5*x\"]\n";
  expect_same(match(render_text(stage() + implicit(round, rotate + way)),
                    render_text(stage() + implicit(round, whirl + way))),
              "turning on its way");
  const auto part = [](const std::string& keys, const std::string& more) {
    return "[[object]]\nshape = \"union\"\n" + more + "[[object.part]]" + keys.substr(keys.find('\n'));
  };
  const std::string straight = "position = [\"0.3*t\", 0.1, 0]\n";
  expect_same(match(render_text(stage() + part(implicit(round, bounded + rotate), straight)),
                    render_text(stage() + part(implicit(round, bounded + whirl), straight))),
              "turning in what goes straight on");
  // Neither alone is faster than light.
  const std::string fast = "matter_velocity = [\"0.7*z\", \"0\", \"-0.7*x\"]\n";
  const std::string faster = implicit(round, fast + "position = [\"0.5*sin(t)\", 0, 0]\n");
  EXPECT_NO_THROW(render_text(stage() + implicit(round, fast)));
  EXPECT_THROW(render_text(stage() + faster), std::exception);

  const std::string moved = implicit(shape, "position = [\"0.3*sin(t)\", 0, 0]\n");
  const std::string gone = "(x - 0.3*sin(t))";
  const std::string wave =
      implicit(gone + "^4 + 2*y^4 + z^4 - 0.5*" + gone + "*z - 0.6",
               "bounds = [[-1.7, -1.3, -1.3], [1.7, 1.3, 1.3]]\nmatter_velocity = [\"0.3*cos(t)\", "
               "\"0\", \"0*x\"]\n");
  expect_same(match(render_text(stage() + moved), render_text(stage() + wave)), "swinging");
}

// What may be seen of a thing is there while its own time says so; behind what is not there the next surface
// is seen.
TEST(Visible, IsAWindowOfTheOwnTimeOfTheMatter) {
  const auto there = [](double own) { return std::sin(9.0 * own) > 0.0; };
  const std::string formula = "visible = \"sin(9*t)\"\n";
  for (const std::string& motion :
       {std::string("position = [0, 0.2, 0]\n"), std::string(swing),
        std::string("position = [0, 0.2, 0]\nrotate = [0, \"40*t\", 0]\n"),
        std::string("position = [0, 0.2, 0]\nrocket = { acceleration = 0.04, along = [0, 1, 0] "
                    "}\n")}) {
    const std::string object = std::string("[[object]]\n") + ball + motion;
    const Rendering always = render_text(stage() + object);
    const Rendering windows = render_text(stage() + object + formula);
    int shown = 0;
    int hidden = 0;
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) {
        if (always.id(x, y) != 2) continue;
        const double own = always.at("properTime.T", x, y);
        if (std::abs(std::sin(9.0 * own)) < 1e-4) continue;
        if (there(own)) {
          ++shown;
          ASSERT_EQ(windows.id(x, y), 2);
          EXPECT_EQ(windows.at("Z", x, y), always.at("Z", x, y));
          EXPECT_NEAR(windows.at("properTime.T", x, y), own, 1e-6);
          EXPECT_EQ(windows.at("N.X", x, y), always.at("N.X", x, y));
          continue;
        }
        ++hidden;
        if (windows.id(x, y) == 2) {  // its far side
          EXPECT_GT(windows.at("Z", x, y), always.at("Z", x, y));
          EXPECT_TRUE(there(windows.at("properTime.T", x, y)));
        }
      }
    }
    EXPECT_GT(shown, 40) << motion;
    EXPECT_GT(hidden, 40) << motion;
  }
}

TEST(Visible, WhatIsNotThereThrowsNoShadow) {
  const std::string object = std::string("[[object]]\n") + ball + swing;
  const Rendering never = render_text(stage() + object + "visible = \"0*t - 1\"\n");
  EXPECT_TRUE(same_bits(never, render_text(stage())));
  const Rendering always = render_text(stage() + object + "visible = \"2 + sin(t)\"\n");
  const Match m = match(render_text(stage() + object), always, Pixels::all);
  EXPECT_EQ(m.other_id, 0);
  EXPECT_EQ(m.worst_seen(), 0.0);
  EXPECT_EQ(m.colour.error, 0.0);
}

}  // namespace
}  // namespace backlight::test
