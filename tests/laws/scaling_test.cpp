// Scaling and rest: docs/physics.md section 5, laws 2 and 3.
#include <gtest/gtest.h>

#include <cstring>
#include <sstream>

#include "backlight/film/compare.h"
#include "rendering.h"
#include "worst.h"

namespace backlight::test {
namespace {

constexpr int width = 48;
constexpr int height = 36;

std::string number(double v) {
  std::ostringstream out;
  out.precision(17);
  out << std::showpoint << v;
  return out.str();
}

std::string vector(double x, double y, double z) {
  return "[" + number(x) + ", " + number(y) + ", " + number(z) + "]";
}

// A moving sphere, box and lamp; lengths times `length`, times times `time`, brightness kept.
std::string scene(double c, double length, double time) {
  const double v = length / time;
  std::string s = film(width, height);
  s += "[camera]\nposition = " + vector(0, length, -9 * length) +
       "\ndirection = [0.05, -0.1, 1]\ntime = " + number(0.4 * time) +
       "\nvelocity = " + vector(0.2 * v, 0, 0.5 * v) + "\n";
  s += "[[object]]\nshape = \"plane\"\nposition = " + vector(0, -length, 0) + "\n";
  s += "[[object]]\nshape = \"sphere\"\nradius = " + number(length) +
       "\nposition = " + vector(1.5 * length, 0.2 * length, length) +
       "\nvelocity = " + vector(0.6 * v, 0.1 * v, -0.3 * v) + "\nmaterial = { color = [0.8, 0.3, 0.2] }\n";
  s += "[[object]]\nshape = \"box\"\nsize = " + vector(length, 2 * length, length) +
       "\nposition = " + vector(-6 * length, 0, 0) + "\nvelocity = " + vector(0.7 * v, 0, 0) +
       "\nrotate = [0, 30, 0]\nmaterial = { color = [0.2, 0.4, 0.7] }\n";
  s += "[[light]]\nposition = " + vector(-3 * length, 6 * length, -6 * length) +
       "\nvelocity = " + vector(0, 0, 0.4 * v) + "\nintensity = \"" + number(200 * length * length) +
       "*(1.5 + sin(t/" + number(time) + "))\"\n";
  return "c = " + number(c * v) + "\n" + s;
}

void expect_same_picture(const Rendering& a, const Rendering& b, double length, double time) {
  int hits = 0;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      if (!a.is_inside(x, y)) continue;
      ASSERT_EQ(a.id(x, y), b.id(x, y)) << x << ' ' << y;
      if (a.id(x, y) == 0) continue;
      ++hits;
      EXPECT_NEAR(b.at("Z", x, y), length * a.at("Z", x, y), 1e-6 * length * a.at("Z", x, y));
      EXPECT_NEAR(b.at("emissionTime.T", x, y), time * a.at("emissionTime.T", x, y), 1e-5 * time);
      EXPECT_NEAR(b.at("doppler.D", x, y), a.at("doppler.D", x, y), 1e-6 * a.at("doppler.D", x, y));
      EXPECT_LE(glm::length(a.rgb(x, y) - b.rgb(x, y)), 1e-5 * glm::length(a.rgb(x, y)));
    }
  }
  EXPECT_GT(hits, width * height / 3);
}

TEST(Scaling, FasterLightWithShorterTimesIsTheSamePicture) {
  // c → kc, velocities × k, times / k.
  const Rendering a = render_text(scene(1.0, 1.0, 1.0));
  const Rendering b = render_text(scene(1.0, 1.0, 1.0 / 7.0));
  expect_same_picture(a, b, 1.0, 1.0 / 7.0);
}

TEST(Scaling, LargerScenesWithLongerTimesAreTheSamePicture) {
  const Rendering a = render_text(scene(1.0, 1.0, 1.0));
  const Rendering b = render_text(scene(1.0, 300.0, 300.0));
  expect_same_picture(a, b, 300.0, 300.0);
}

TEST(Rest, VelocityZeroInAnyFormChangesNoBit) {
  const std::string head = film(width, height) + "[camera]\nposition = [0, 1, -6]\nlook_at = [0, 0, 0]\n";
  const std::string tail =
      "[[light]]\nposition = [2, 5, -4]\nintensity = 90\n[[object]]\nshape = \"plane\"\nposition = [0, -1, "
      "0]\n";
  const std::string ball =
      "[[object]]\nshape = \"torus\"\nmajor = 1\nminor = 0.4\nrotate = [50, 0, 20]\nposition = [0.3, 0.2, "
      "0.1]\n";
  const Rendering plain = render_text(head + tail + ball);
  for (const char* motion : {"velocity = [0, 0, 0]\n", "beta = [0, 0, 0]\n", "gamma = 1\nalong = [1, 0, 0]\n",
                             "celerity = 0\nalong = [1, 2, 3]\n", "rapidity = 0\nalong = [0, 1, 0]\n"}) {
    const Rendering other = render_text(head + tail + ball + motion);
    for (const char* channel : {"R", "G", "B"}) {
      const auto a = plain.image.plane(static_cast<std::size_t>(plain.image.find_channel(channel)));
      const auto b = other.image.plane(static_cast<std::size_t>(other.image.find_channel(channel)));
      ASSERT_EQ(a.size(), b.size());
      EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size_bytes()), 0) << motion << channel;
    }
  }
}

TEST(Rest, EverythingMovingTogetherIsTheClassicalPicture) {
  const std::string things =
      "[background]\nframe = \"train\"\n[[light]]\nframe = \"train\"\nposition = [2, 5, -4]\nintensity = 90\n"
      "[[object]]\nframe = \"train\"\nshape = \"plane\"\nposition = [0, -1, 0]\n"
      "[[object]]\nframe = \"train\"\nshape = \"sphere\"\nradius = 1\n"
      "[camera]\nframe = \"train\"\nposition = [0, 1, -6]\ndirection = [0, -0.2, 1]\ntime = 2.5\n";
  const Rendering rest = render_text(film(width, height) + "[frame.train]\n" + things);
  const Rendering moving =
      render_text(film(width, height) +
                  "[frame.train]\ngamma = 1e6\nalong = [1, 2, -0.5]\norigin = [7, -3, 1]\n"
                  "origin_time = 1e9\n" +
                  things);
  for (const char* channel : {"R", "G", "B", "Z", "doppler.D", "P.X", "objectId.V"}) {
    const auto a = rest.image.plane(static_cast<std::size_t>(rest.image.find_channel(channel)));
    const auto b = moving.image.plane(static_cast<std::size_t>(moving.image.find_channel(channel)));
    Worst worst;
    for (std::size_t i = 0; i < a.size(); ++i) worst.take(value_difference(a[i], b[i]));
    EXPECT_LE(worst.error, 1e-6) << channel;
  }
}

}  // namespace
}  // namespace backlight::test
