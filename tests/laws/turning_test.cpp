// Matter that turns: docs/physics.md section 13.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "matter_scenes.h"

namespace backlight::test {
namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

// An angle in degrees that grows by `omega` radians a second.
std::string angle(double omega) {
  return "\"" + digits(degrees * omega) + "*t\"";
}

Vec3 data(const Rendering& r, const char* layer, int x, int y) {
  const std::string name = layer;
  return {r.at((name + ".X").c_str(), x, y), r.at((name + ".Y").c_str(), x, y),
          r.at((name + ".Z").c_str(), x, y)};
}

struct Turner {
  const char* keys;
  double widest;  ///< farthest from the y axis
};

const Turner turners[] = {{"shape = \"sphere\"\nradius = 1.2\n", 1.2},
                          {"shape = \"cylinder\"\nradius = 1\nheight = 1.5\n", 1.0},
                          {"shape = \"cone\"\nradius = 1.2\ntop_radius = 0.4\nheight = 1.5\n", 1.2},
                          {"shape = \"torus\"\nmajor = 0.9\nminor = 0.4\n", 1.3},
                          {"shape = \"disk\"\nradius = 1.5\n", 1.5}};

const char* const lit = "[[light]]\ntype = \"point\"\nposition = [3, 5, -3]\nintensity = 60\n";

// About an axis through `centre` along the turned y axis. The cameras are at the world's origin at its time
// 0.
class Turning : public testing::TestWithParam<std::tuple<int, double>> {
 protected:
  const Turner& turner() const { return turners[std::get<0>(GetParam())]; }
  double omega() const { return std::get<1>(GetParam()) / turner().widest; }
};

TEST_P(Turning, AboutItsOwnAxisIsWhereTheUnturnedIsWithTheDopplerFactorOfItsMatter) {
  const Vec3 centre{0.3, -0.2, 4};
  constexpr double tilt = 25.0 / degrees;
  const Vec3 axis{-std::sin(tilt), std::cos(tilt), 0};
  const std::string object = std::string("[[object]]\n") + turner().keys + "position = " + list(centre);
  for (const char* eye : {"", "beta = [0.3, 0.2, -0.4]\n"}) {
    const std::string rest =
        film(64, 48) + "[camera]\ndirection = [0.05, 0, 1]\nup = [0.1, 1, 0]\nfov = 60\n" + eye + lit;
    const Rendering still = render_text(rest + object + "\nrotate = [0, 40, 25]\n");
    const Rendering turned = render_text(rest + object + "\nrotate = [0, " + angle(omega()) + ", 25]\n");
    int seen = 0;
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) {
        for (const char* channel : {"objectId.V", "Z", "emissionTime.T", "P.X", "P.Y", "P.Z"}) {
          ASSERT_EQ(still.at(channel, x, y), turned.at(channel, x, y)) << channel << ' ' << x << ' ' << y;
        }
        if (turned.id(x, y) == 0) continue;
        ++seen;
        EXPECT_LT(glm::length(still.normal(x, y) - turned.normal(x, y)), 3e-7);
        const Vec3 away = turned.position(x, y) - centre;
        const Vec3 v = omega() * glm::cross(axis, away);
        const double gamma = lorentz_factor(v);
        const double expected = still.at("doppler.D", x, y) /
                                (gamma * (1.0 + glm::dot(v, glm::normalize(turned.position(x, y)))));
        // P is told to 24 bits, by which v is off.
        const double unsure = 1e-6 * gamma * gamma;
        EXPECT_NEAR(turned.at("doppler.D", x, y) / expected, 1.0, unsure) << x << ' ' << y;
        const double time = turned.at("emissionTime.T", x, y);
        EXPECT_NEAR(turned.at("properTime.T", x, y) / (time / gamma), 1.0, unsure);
      }
    }
    EXPECT_GT(seen, 120);
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, Turning,
                         testing::Combine(testing::Range(0, 5), testing::Values(-0.2, 0.7, 0.995)));

// The closed form that stays where it is, and the search for a formula that turns, are the same body: also
// its light and its texture, if it turns by a formula that is not even.
TEST(TurningMatter, BodiesOfRevolutionLookLikeTheirFormulasInMotion) {
  const std::string rest = film(64, 48) + "[camera]\nbeta = [0.2, 0, 0.3]\nfov = 60\n" + lit;
  const std::string checker =
      "material = { checker = { colors = [[0.9, 0.3, 0.2], [0.1, 0.3, 0.6]], size = 0.125 } }\n";
  for (const auto& [closed, formula] :
       {std::pair{"shape = \"sphere\"\nradius = 1.2\n",
                  "shape = \"implicit\"\nf = \"x^2 + y^2 + z^2 - 1.44\"\n"},
        std::pair{"shape = \"cylinder\"\nradius = 1\nheight = 1.5\n", "shape = \"union\"\n"}}) {
    const std::string motion = "position = [0.3, -0.2, 4]\nrotate = [0, \"15*t + 4*sin(2*t)\", 25]\n";
    const bool is_union = std::string(formula) == "shape = \"union\"\n";
    const Rendering a = render_text(rest + "[[object]]\n" + closed + motion + checker);
    const Rendering b = render_text(rest + "[[object]]\n" + formula + motion + checker +
                                    (is_union ? std::string("[[object.part]]\n") + closed : ""));
    const Match m = match(a, b);
    EXPECT_GT(m.seen, 300);
    EXPECT_EQ(m.other_id, 0);
    EXPECT_LT(m.worst_seen(), 1e-6);
    EXPECT_LT(m.own_time.error, 1e-6);
    EXPECT_LT(m.position.error, 1e-6);
    EXPECT_LT(m.colour.error, 1e-5) << m.colour.where;
  }
}

std::string wheel(const std::string& motion) {
  return "[[object]]\nname = \"wheel\"\nshape = \"difference\"\nposition = [1, 2, 3]\n" + motion +
         "[[object.part]]\nshape = \"cylinder\"\nradius = 1\nheight = 1\n[[object.part]]\nshape = "
         "\"cylinder\"\nradius = 0.9\nheight = 0.8\n[[object.part]]\nshape = \"box\"\nsize = [0.3, 0.4, "
         "0.4]\nposition = "
         "[0.5, -0.45, 0]\nrotate = [0, 30, 0]\n";
}

// Distance from the axis of the point that a pixel shows.
double from_axis(const Rendering& r, int x, int y) {
  const Vec3 away = data(r, "P", x, y) - Vec3{1, 2, 3};
  return std::hypot(away.x, away.z);
}

// A camera on the axis sees γ alone: nothing of the motion is along its way.
TEST(TurningMatter, AWheelSeenFromItsHubHasTheDopplerFactorOfItsClocks) {
  for (const double omega : {0.1, -0.6, 0.95}) {
    const Rendering r = render_text(film(64, 32) +
                                    "[camera]\nposition = [1, 2.1, 3]\nprojection = "
                                    "\"equirectangular\"\ntime = 0.7\n" +
                                    wheel("rotate = [0, " + angle(omega) + ", 0]\n"));
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 64; ++x) {
        if (r.id(x, y) == 0) continue;  // through the window
        const double rho = from_axis(r, x, y);
        EXPECT_NEAR(r.at("doppler.D", x, y), std::sqrt(1.0 - omega * omega * rho * rho), 2e-6);
      }
    }
  }
}

// Born's observers: D = √((1 - ω²ρ²)/(1 - ω²R²)) from the matter at ρ to a camera at R, so 1 from rim to rim.
// What they see never changes.
TEST(TurningMatter, ACameraThatTurnsAlongSeesTheRatioOfTheClocks) {
  for (const double omega : {0.1, -0.6, 0.95}) {
    const double at = 0.7;
    std::string scene =
        film(64, 32) +
        "[camera]\naboard = \"wheel\"\nposition = [0, 0.1, 0.7]\nprojection = "
        "\"equirectangular\"\n" +
        wheel("rotate = [0, " + angle(omega) + ", 0]\n") +
        // on the axis, and one that goes round with it
        "[[light]]\nposition = [1, 2.3, 3]\nintensity = 1\n[[light]]\nintensity = 0.5\nposition = "
        "[\"1 + 0.5*sin(" +
        digits(omega) + "*t)\", 2, \"3 + 0.5*cos(" + digits(omega) + "*t)\"]\n";
    const Rendering first = render_text(scene);
    int on_rim = 0;
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 64; ++x) {
        if (first.id(x, y) == 0) continue;
        const double rho = from_axis(first, x, y);
        if (std::abs(rho - 0.9) < 1e-6) ++on_rim;
        EXPECT_NEAR(first.at("doppler.D", x, y),
                    std::sqrt((1.0 - omega * omega * rho * rho) / (1.0 - omega * omega * at * at)), 5e-6);
      }
    }
    EXPECT_GT(on_rim, 400);
    for (const double time : {-2.3, 0.9, 40.0}) {
      RenderChoices later;
      later.time = time;
      const Match m = match(first, render_text(scene, later));
      EXPECT_GT(m.seen, 1000);
      EXPECT_EQ(m.other_id, 0);
      EXPECT_LT(m.distance.error, 2e-6) << omega << ' ' << time;
      EXPECT_LT(m.doppler.error, 2e-6);
      EXPECT_LT(m.colour.error, 2e-5) << omega << ' ' << time << " at " << m.colour.where;
    }
  }
}

// The wheel is at rest in a frame that moves at v and turns by ωr = v there. Where it touches the road it is
// at rest on the road, and everywhere the velocities add up.
TEST(TurningMatter, TheRollingWheelIsAtRestWhereItTouchesTheRoad) {
  for (const double v : {0.05, 0.6, 0.95}) {
    const double gamma = lorentz_factor({v, 0, 0});
    // Front and rear caps are at z = ∓0.1. It is at x = 0 when light leaves it for the camera at world time
    // 0.
    const std::string rest =
        "[frame.hub]\nvelocity = [" + digits(v) + ", 0, 0]\norigin = [" + digits(3.9 * v) +
        ", 1, 0]\n[[object]]\nshape = \"cylinder\"\nradius = 1\nheight = 0.2\nframe = "
        "\"hub\"\nrotate = [90, 0, " +
        angle(-v) + "]\n[[object]]\nshape = \"box\"\nsize = [60, 1, 60]\nposition = [0, -0.5, 0]\n";
    // Its point just above the road, seen from straight before it.
    const double above = 1e-6;
    const Rendering touching = render_text(film(3, 3) + "[camera]\nposition = [0, " + digits(above) +
                                           ", -4]\ndirection = [0, 0, 1]\nfov = 1e-7\n" + rest);
    ASSERT_EQ(touching.id(1, 1), 1);
    EXPECT_NEAR(touching.at("doppler.D", 1, 1), 1.0, 4.0 * above * v * gamma * gamma);
    const Rendering r = render_text(
        film(64, 48) + "[camera]\nposition = [0, 0.9, -4]\ndirection = [0, 0, 1]\nfov = 60\n" + rest);
    int seen = 0;
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) {
        if (r.id(x, y) == 2) {
          EXPECT_EQ(r.at("doppler.D", x, y), 1.0);
        }
        if (r.id(x, y) != 1) continue;
        ++seen;
        const Vec3 d = r.direction(x, y);
        const double w = gamma * (1.0 + v * d.x);
        const Vec3 in_hub{gamma * (d.x + v) / w, d.y / w, d.z / w};
        const Vec3 matter = -v * glm::cross(Vec3{0, 0, 1}, r.position(x, y));
        const double fast = lorentz_factor(matter);
        EXPECT_NEAR(r.at("doppler.D", x, y) * (w * fast * (1.0 + glm::dot(matter, in_hub))), 1.0,
                    2e-6 * fast * fast);
      }
    }
    EXPECT_GT(seen, 200);
  }
}

// What turns within what turns about the same axis turns by the sum.
TEST(TurningMatter, OfAPartAddsUpWithThatOfTheWhole) {
  const std::string rest = film(64, 48) + "[camera]\nfov = 60\n" + lit;
  const auto scene = [&](const std::string& whole, const std::string& part) {
    return rest + "[[object]]\nshape = \"union\"\nposition = [0, 0, 5]\nrotate = [0, " + whole +
           ", 20]\n[[object.part]]\nshape = \"box\"\nsize = [1.5, 1, 0.8]\nrotate = [0, " + part + ", 0]\n";
  };
  const Rendering once = render_text(scene("\"40*t\"", "0"));
  const Match both = match(once, render_text(scene("\"15*t\"", "\"25*t\"")));
  const Match within = match(once, render_text(scene("0", "\"40*t\"")));
  for (const Match& m : {both, within}) {
    expect_same(m, "", 100);
  }
}

TEST(TurningMatter, SlowlyIsTheBodyAtRest) {
  const std::string rest = film(64, 48) + "[camera]\nfov = 60\nbeta = [0.2, 0.1, 0.1]\n" + lit;
  const std::string box =
      "[[object]]\nshape = \"box\"\nsize = [1.5, 1, 0.8]\nposition = [0, 0, 5]\nrotate = ";
  const Match m = match(render_text(rest + box + "[10, 20, 30]\n"),
                        render_text(rest + box + "[\"10 + 1e-9*t\", \"20 - 1e-9*t\", \"30 + 1e-9*t\"]\n"));
  expect_same(m, "", 100);
}

}  // namespace
}  // namespace backlight::test
