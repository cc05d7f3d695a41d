// Spot lamps: their cones on rendered floors, at rest, in motion and on paths; and when their light left.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "rendering.h"

namespace backlight::test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

// A floor at rest from above, under one lamp.
std::string floor_under(const std::string& lamp, const std::string& more = "") {
  return "[film]\nresolution = [48, 48]\nsamples = 1\n"
         "aovs = [\"P\", \"emissionTime\", \"objectId\", \"lampTime\", \"light\"]\n"
         "[camera]\nposition = [0, 12, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, 1]\n"
         "[[object]]\nshape = \"plane\"\nmaterial = { color = [0.7, 0.5, 0.3] }\n"
         "[[light]]\nintensity = 100\n" +
         lamp + more;
}

// physics.md equation (12a), written once more.
double share_of(double angle, double full_degrees, double edge) {
  const double rim = 0.5 * full_degrees * degree;
  const double s = std::clamp((rim - angle) / (edge * rim), 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// A direction of light, as who moves with this velocity sees it: aberration.
Vec3 aberrated(const Vec3& n, const Vec3& v) {
  const double gamma = 1.0 / std::sqrt(1.0 - glm::dot(v, v));
  const double along = glm::dot(v, n);
  return (n + (gamma * gamma / (gamma + 1.0) * along - gamma) * v) / (gamma * (1.0 - along));
}

struct Emission {
  double time = 0.0;  // of the world
  Vec3 direction{0.0};
  Vec3 velocity{0.0};
};

// When a lamp with this place at a time sent what arrives at an event: by halving, in the world.
Emission emission_of(const std::function<Vec3(double)>& place, const Vec3& point, double time) {
  double low = time - 1000.0;
  double high = time;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (glm::length(point - place(middle)) < time - middle ? low : high) = middle;
  }
  const double step = 1e-5;
  return {low, glm::normalize(point - place(low)), (place(low + step) - place(low - step)) / (2.0 * step)};
}

// Of every pixel, what a spot lamp gives by what a point lamp gives there, and the own time at which it did.
// `axis` is a function of the own time.
void expect_cone(const std::string& motion, const std::string& cone, const std::function<Vec3(double)>& place,
                 const std::function<Vec3(double)>& axis, double angle, double edge,
                 const std::function<double(double)>& own_time, const std::string& effects) {
  const Rendering spot = render_text(floor_under("type = \"spot\"\n" + motion + cone, effects));
  const Rendering point = render_text(floor_under(motion, effects));
  int lit = 0, faded = 0, dark = 0;
  for (int y = 0; y < spot.height(); ++y) {
    for (int x = 0; x < spot.width(); ++x) {
      const Emission sent = emission_of(place, spot.position(x, y), spot.at("emissionTime.T", x, y));
      const Vec3 leaving = aberrated(sent.direction, sent.velocity);
      const double share = share_of(angle_between(leaving, axis(own_time(sent.time))), angle, edge);
      for (const char* channel : {"R", "G", "B"}) {
        const double whole = point.at(channel, x, y);
        ASSERT_NEAR(spot.at(channel, x, y), share * whole, 1.5e-3 * whole + 1e-7) << x << ", " << y;
      }
      if (share > 1e-4) {
        EXPECT_NEAR(spot.at("lampTime.1", x, y), own_time(sent.time), 2e-5) << x << ", " << y;
      } else if (share == 0.0) {
        EXPECT_EQ(spot.at("lampTime.1", x, y), -std::numeric_limits<double>::infinity()) << x << ", " << y;
        EXPECT_EQ(spot.at("light.N", x, y), 0.0);
      }
      EXPECT_NEAR(point.at("lampTime.1", x, y), own_time(sent.time), 2e-5);
      lit += share == 1.0 ? 1 : 0;
      faded += share > 0.0 && share < 1.0 ? 1 : 0;
      dark += share == 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(lit, 20) << motion;
  EXPECT_GT(faded, 20) << motion;
  EXPECT_GT(dark, 200) << motion;
  EXPECT_EQ(spot.statistics.rays.non_finite, 0U);
}

std::function<Vec3(double)> always(const Vec3& axis) {
  return [axis](double) { return axis; };
}

const char* const three_colours = "[effects]\ndoppler = false\n";

TEST(SpotLamp, ShinesIntoItsCone) {
  const Vec3 place{0.5, 4.0, -1.0};
  expect_cone(
      "position = [0.5, 4, -1]\n", "direction = [0.2, -2, 0.4]\nangle = 70\nedge = 0.4\n",
      [&](double) { return place; }, always({0.2, -2.0, 0.4}), 70.0, 0.4, [](double t) { return t; }, "");
}

// The cone is one in the lamp's frame: on the floor it is where aberration brings it, ahead of the lamp.
TEST(SpotLamp, InMotionHasAnAberratedCone) {
  for (const Vec3& v : {Vec3{0.6, 0.0, 0.0}, Vec3{0.5, -0.3, 0.6}, Vec3{-0.2, -0.1, 0.93}}) {
    const double gamma = 1.0 / std::sqrt(1.0 - glm::dot(v, v));
    char motion[160];
    std::snprintf(motion, sizeof motion, "position = [1, 4, -1]\nvelocity = [%.17g, %.17g, %.17g]\n", v.x,
                  v.y, v.z);
    // Where its light left that comes to the camera now, the lamp was above the middle of the floor.
    const double back = 14.0;
    std::string starts = motion;
    const Vec3 start = Vec3{0.0, 4.0, 0.0} + back * v;
    std::snprintf(motion, sizeof motion, "position = [%.17g, %.17g, %.17g]\n", start.x, start.y, start.z);
    starts = motion + starts.substr(starts.find('\n') + 1);
    for (const char* effects : {"", three_colours}) {
      expect_cone(
          starts, "direction = [0.1, -1, 0.2]\nangle = 100\nedge = 0.5\n",
          [&](double t) { return start + t * v; }, always({0.1, -1.0, 0.2}), 100.0, 0.5,
          [&](double t) { return t / gamma; }, effects);
    }
  }
}

// On a circle at 0.7 c its axis stays where it is, along axes that are carried by the pure boost.
TEST(SpotLamp, OnAPathKeepsItsAxis) {
  const double radius = 1.5, speed = 0.7;
  const double rate = speed / radius;
  expect_cone(
      "position = [\"1.5*cos(0.7/1.5*t)\", 4, \"1.5*sin(0.7/1.5*t)\"]\n",
      "direction = [0.1, -1, 0]\nangle = 90\nedge = 0.6\n",
      [&](double t) {
        return Vec3{radius * std::cos(rate * t), 4.0, radius * std::sin(rate * t)};
      },
      always({0.1, -1.0, 0.0}), 90.0, 0.6, [&](double t) { return t * std::sqrt(1.0 - speed * speed); }, "");
}

// A lighthouse: the beam has the direction of the lamp's own time at emission, however the lamp moves.
TEST(SpotLamp, TurnsByItsOwnTime) {
  const char* const beam = "direction = [\"cos(0.9*t)\", -0.7, \"sin(0.9*t)\"]\nangle = 80\nedge = 0.5\n";
  const auto axis = [](double t) { return Vec3{std::cos(0.9 * t), -0.7, std::sin(0.9 * t)}; };
  const Vec3 place{0.5, 4.0, -1.0};
  const auto own = [](double t) { return t; };
  expect_cone(
      "position = [0.5, 4, -1]\n", beam, [&](double) { return place; }, axis, 80.0, 0.5, own, "");
  const Vec3 v{0.6, 0.0, 0.0}, start{8.4, 4.0, 0.0};
  expect_cone(
      "position = [8.4, 4, 0]\nvelocity = [0.6, 0, 0]\n", beam, [&](double t) { return start + t * v; }, axis,
      80.0, 0.5, [](double t) { return 0.8 * t; }, three_colours);
  expect_cone(
      "position = [\"1.5*cos(0.4*t)\", 4, \"1.5*sin(0.4*t)\"]\n", beam,
      [](double t) {
        return Vec3{1.5 * std::cos(0.4 * t), 4.0, 1.5 * std::sin(0.4 * t)};
      },
      axis, 80.0, 0.5, [](double t) { return 0.8 * t; }, "");
}

// While the axis is zero the lamp is dark, and no picture has a NaN of it.
TEST(SpotLamp, WithoutADirectionIsDark) {
  const Rendering r = render_text(floor_under(
      "type = \"spot\"\nposition = [0, 4, 0]\ndirection = [0, \"min(t + 20, 0)\", 0]\nangle = 90\n"));
  EXPECT_EQ(r.rgb(24, 24), Vec3(0.0));
  EXPECT_EQ(r.statistics.rays.non_finite, 0U);
}

TEST(SpotLamp, OfTheWholeSphereIsAPointLamp) {
  const std::string place = "position = [0.5, 4, -1]\n";
  const Rendering spot =
      render_text(floor_under("type = \"spot\"\ndirection = [0, 1, 0]\nangle = 360\n" + place));
  const Rendering point = render_text(floor_under(place));
  for (int y = 0; y < spot.height(); ++y) {
    for (int x = 0; x < spot.width(); ++x) ASSERT_EQ(spot.rgb(x, y), point.rgb(x, y)) << x << ", " << y;
  }
}

// What stands in the way takes the lamp's time away, and an ambient light has the surface's.
TEST(LampTime, IsThatOfWhatArrives) {
  const Rendering r =
      render_text(floor_under("position = [0, 4, 0]\n",
                              "[[object]]\nshape = \"sphere\"\nradius = 0.5\nposition = [0.6, 2, 0.4]\n"
                              "[[light]]\ntype = \"ambient\"\nradiance = 0.1\n"
                              "[[light]]\ntype = \"distant\"\ndirection = [0.3, -1, "
                              "0.2]\n[[light]]\nposition = [0, -3, 0]\nintensity = 9\n"));
  int shaded = 0;
  for (int y = 0; y < r.height(); ++y) {
    for (int x = 0; x < r.width(); ++x) {
      const double time = r.at("emissionTime.T", x, y);
      const Vec3 p = r.position(x, y);
      int lamps = 0;
      for (const char* channel : {"lampTime.1", "lampTime.2", "lampTime.3", "lampTime.4"})
        lamps += std::isfinite(r.at(channel, x, y)) ? 1 : 0;
      EXPECT_EQ(lamps, r.at("light.N", x, y)) << x << ", " << y;
      EXPECT_NEAR(r.at("lampTime.2", x, y), time, 1e-6);
      if (r.id(x, y) != 1) continue;
      EXPECT_EQ(r.at("lampTime.4", x, y), -std::numeric_limits<double>::infinity());  // it is below the floor
      const double first = r.at("lampTime.1", x, y);
      shaded += std::isfinite(first) ? 0 : 1;
      if (std::isfinite(first)) {
        EXPECT_NEAR(first, time - glm::length(p - Vec3{0.0, 4.0, 0.0}), 1e-5);
      }
      const Vec3 way = Vec3{0.3, -1.0, 0.2} / std::sqrt(1.13);
      const double front = r.at("lampTime.3", x, y);
      if (std::isfinite(front)) {
        EXPECT_NEAR(front, time - glm::dot(way, p), 1e-5);
      }
    }
  }
  EXPECT_GT(shaded, 20);
}

TEST(LampTime, IsMinusInfinityWhereNothingIs) {
  const Rendering r = render_text(
      "[film]\nresolution = [8, 8]\naovs = [\"lampTime\"]\n[camera]\n[[light]]\nposition = [1, 1, 1]\n");
  EXPECT_EQ(r.at("lampTime.1", 3, 3), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(r.statistics.rays.non_finite, 0U);
}

}  // namespace
}  // namespace backlight::test
