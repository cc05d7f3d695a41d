// Bodies in Born-rigid flight: docs/physics.md section 13.
#include <gtest/gtest.h>

#include <cmath>

#include "matter_scenes.h"

namespace backlight::test {
namespace {

const Vec3 start{0.5, 1, 2};
const Vec3 thrust = glm::normalize(Vec3{0.3, 0.2, 1});
constexpr double acceleration = 0.4;

std::string rocket(double size) {
  return "rocket = { acceleration = " + digits(size) + ", along = " + list(thrust) + " }\n";
}

// In units of the light's way: how far a point, given from the start, is from the horizon at time 0.
double xi(const Vec3& from_start) {
  return 1.0 / acceleration + glm::dot(from_start, thrust);
}

/// A hollow cabin with a window, and a lamp in it that flies along.
std::string cabin() {
  const Vec3 lamp{0.3, 0.6, 0.4};
  return "[[object]]\nname = \"cabin\"\nshape = \"difference\"\nposition = " + list(start) +
         "\nrotate = [0, 0, 30]\n" + rocket(acceleration) +
         "material = { color = [0.7, 0.5, 0.3] }\n"
         "[[object.part]]\nshape = \"box\"\nsize = [2, 2, 2.4]\n[[object.part]]\nshape = \"box\"\nsize = "
         "[1.8, 1.8, "
         "2.2]\n[[object.part]]\nshape = \"sphere\"\nradius = 0.5\nposition = [1, 0, 0.3]\n"
         "[[light]]\nposition = " +
         list(start + lamp) + "\nintensity = 2\n" + rocket(1.0 / xi(lamp));
}

// A camera aboard at a place of the cabin's own coordinates.
std::string aboard(const Vec3& place) {
  return "[camera]\naboard = \"cabin\"\nposition = " + list(place) + "\nprojection = \"equirectangular\"\n";
}

Vec3 turned(const Vec3& v) {  // by the cabin's 30 degrees about z
  const double c = std::sqrt(0.75);
  return {c * v.x - 0.5 * v.y, 0.5 * v.x + c * v.y, v.z};
}

// Einstein's elevator: the light from below is red, the light from above is blue, by the ratio of the
// distances to the horizon.
TEST(Accelerating, AboardARocketTheDopplerFactorIsTheRatioOfTheDistancesFromTheHorizon) {
  const Vec3 eye{0.2, -0.1, -0.5};
  const Rendering r = render_text(film(64, 32) + aboard(eye) + cabin());
  double least = 1.0;
  double most = 1.0;
  int seen = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      if (r.id(x, y) == 0) continue;
      ++seen;
      const double ahead = xi(r.position(x, y) - start);
      const double time = r.at("emissionTime.T", x, y);
      const double doppler = std::sqrt(ahead * ahead - time * time) / xi(turned(eye));
      EXPECT_NEAR(r.at("doppler.D", x, y), doppler, 3e-6) << x << ' ' << y;
      EXPECT_NEAR(r.at("properTime.T", x, y),
                  std::sqrt(ahead * ahead - time * time) * std::atanh(time / ahead), 3e-6);
      least = std::min(least, doppler);
      most = std::max(most, doppler);
    }
  }
  EXPECT_GT(seen, 1800);
  EXPECT_LT(least, 0.8);
  EXPECT_GT(most, 1.5);
}

TEST(Accelerating, AboardARocketThePictureNeverChanges) {
  const std::string scene = film(64, 32) + aboard({0.2, -0.1, -0.5}) + cabin();
  const Rendering first = render_text(scene);
  for (const double time : {-3.0, 1.7, 8.0}) {  // γ up to 17
    RenderChoices later;
    later.time = time;
    const Match m = match(first, render_text(scene, later));
    EXPECT_GT(m.seen, 1500);
    EXPECT_EQ(m.other_id, 0) << time;
    EXPECT_LT(m.distance.error, 1e-6) << time;
    EXPECT_LT(m.doppler.error, 1e-6) << time;
    EXPECT_LT(m.normal.error, 1e-6) << time;
    EXPECT_LT(m.colour.error, 1e-5) << time << " at " << m.colour.where;
  }
}

// The same camera, told by its own rocket.
TEST(Accelerating, ACameraAboardIsOneWithTheRocketOfItsPlace) {
  const Vec3 eye{0.2, -0.1, -0.5};
  const double ahead = xi(turned(eye));
  const std::string own = "[camera]\nposition = " + list(start + turned(eye)) +
                          "\ndirection = " + list(turned({0, 0, 1})) + "\nup = " + list(turned({0, 1, 0})) +
                          "\nprojection = \"equirectangular\"\n" + rocket(1.0 / ahead);
  for (const double time : {-1.5, 0.0, 2.5}) {
    RenderChoices at;
    at.time = time;
    const Match m = match(render_text(film(64, 32) + aboard(eye) + cabin(), at),
                          render_text(film(64, 32) + own + cabin(), at));
    expect_same(m, "", 1500);
  }
}

// From outside: v = t/(ξ cosh) along the thrust, at each point's own.
TEST(Accelerating, ARocketSeenFromTheGroundHasTheDopplerFactorsOfItsMatter) {
  for (const double time : {5.0, 8.0, 14.0}) {
    RenderChoices at;
    at.time = time;
    const Rendering r = render_text(film(64, 48) +
                                        "[camera]\nposition = [0, 0.5, -3]\nlook_at = [0.6, 1.2, 2]\nfov = "
                                        "50\n" +
                                        cabin(),
                                    at);
    int seen = 0;
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) {
        if (r.id(x, y) == 0) continue;
        ++seen;
        const double ahead = xi(r.position(x, y) - start);
        const double t = r.at("emissionTime.T", x, y);
        const Vec3 v = t / ahead * thrust;
        const double gamma = lorentz_factor(v);
        const double doppler = 1.0 / (gamma * (1.0 + glm::dot(v, r.direction(x, y))));
        EXPECT_NEAR(r.at("doppler.D", x, y) / doppler, 1.0, 1e-6 * gamma * gamma) << x << ' ' << y;
      }
    }
    EXPECT_GT(seen, 30) << time;
  }
}

// A rocket's frame may move: all of it within another frame is the same, seen by a camera that moves along.
TEST(Accelerating, ARocketOfAMovingFrameIsOneAtRestSeenByACameraOfThatFrame) {
  const std::string in_frame = "frame = \"fleet\"\n";
  std::string moving = cabin();
  for (const std::string key : {"[[object]]\n", "[[light]]\n"})
    moving.insert(moving.find(key) + key.size(), in_frame);
  const std::string camera =
      "[camera]\nposition = [0, 0.5, -3]\nlook_at = [0.6, 1.2, 2]\nfov = 50\ntime = 3\n";
  const Match m = match(render_text(film(64, 48) + camera + cabin()),
                        render_text(film(64, 48) + "[frame.fleet]\ncelerity = 20\nalong = [1, 0.5, -2]\n" +
                                    camera + in_frame + moving));
  EXPECT_GT(m.seen, 100);
  EXPECT_EQ(m.other_id, 0);
  EXPECT_LT(m.distance.error, 1e-6);
  EXPECT_LT(m.doppler.error, 1e-6);
  EXPECT_LT(m.normal.error, 1e-6);
  EXPECT_LT(m.own_time.error, 1e-6);
  EXPECT_LT(m.position.error, 1e-6);
  EXPECT_LT(m.colour.error, 1e-5);
}

TEST(Accelerating, SlightlyIsTheBodyAtRest) {
  const std::string rest =
      film(64, 48) +
      "[camera]\nfov = 60\nbeta = [0.2, 0.1, 0.1]\n[[light]]\nposition = [3, 5, 0]\nintensity = 50\n"
      "[[object]]\nshape = \"box\"\nsize = [1.5, 1, 0.8]\nposition = [0, 0, 4]\nrotate = [10, 20, "
      "30]\n";
  const Match m = match(render_text(rest), render_text(rest + rocket(1e-9)));
  expect_same(m, "", 100);
}

// A fall of small speed: half the acceleration times the time squared, and the Doppler factor 1 - v·d.
TEST(Accelerating, SlowlyIsGalileosFall) {
  const double g = 1e-4;
  const Rendering r = render_text(film(9, 9) +
                                  "[camera]\ntime = 7\nfov = 1\n[[object]]\nshape = \"disk\"\nradius = "
                                  "1\nrotate = [90, 0, 0]\nposition = "
                                  "[0, 0, 2]\nrocket = { acceleration = 1e-4, along = [0, 0, 1] }\n");
  const double t = 5.0;  // of emission, but for g
  EXPECT_NEAR(r.at("Z", 4, 4), 2.0 + 0.5 * g * t * t, 1e-6);
  EXPECT_NEAR(r.at("doppler.D", 4, 4), 1.0 - g * t, 1e-6);
}

}  // namespace
}  // namespace backlight::test
