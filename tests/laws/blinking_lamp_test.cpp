// What a moving camera films goes by at the rate of the Doppler factor: docs/physics.md, equation (18).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <vector>

#include "rendering.h"

namespace backlight::test {
namespace {

std::string list(const Vec3& v) {
  std::ostringstream text;
  text.precision(17);
  text << '[' << v.x << ", " << v.y << ", " << v.z << ']';
  return text.str();
}

// A far ball under a lamp that blinks by its own clock once in 2π, both at rest, and a camera on the path
// `velocity`·t which looks at it.
class Film {
 public:
  Film(const Vec3& towards, const Vec3& velocity) {
    const double speed2 = glm::dot(velocity, velocity);
    gamma_ = 1.0 / std::sqrt(1.0 - speed2);
    doppler_ = gamma_ * (1.0 + glm::dot(towards, velocity));
    // The ball's direction, aberrated: the spatial part of the boosted (-1; towards), over its length.
    const Vec3 aim =
        towards + gamma_ * velocity * (gamma_ / (gamma_ + 1.0) * glm::dot(towards, velocity) + 1.0);
    std::ostringstream path;
    path.precision(17);
    path << "[\"" << velocity.x << "*t\", \"" << velocity.y << "*t\", \"" << velocity.z << "*t\"]";
    constexpr double away = 1e9;  // so far, and the ball so large, that the camera sees it from one place
    text_ = "[film]\nresolution = [3, 3]\naovs = [\"doppler\", \"objectId\"]\n[camera]\nposition = " +
            path.str() + "\ndirection = " + list(aim) + "\nup = [0.3, 1, 0.1]\nfov = 0.01\n" +
            "[[light]]\ntype = \"point\"\nintensity = \"1e13*(1 + 0.9*sin(t))\"\nposition = " +
            list((away - 2e6) * towards) +
            "\n[[object]]\nshape = \"sphere\"\nradius = 1e6\nposition = " + list(away * towards) + '\n';
  }

  [[nodiscard]] double doppler() const { return doppler_; }

  // The period that the camera sees, by its own clock: between the first and the last time that the ball gets
  // brighter than half way.
  [[nodiscard]] double seen_period() const {
    constexpr int images = 120;
    const double step = 0.35 * gamma_ / doppler_;  // of world time: 0.35 rad of the lamp's
    std::vector<double> bright;
    for (int i = 0; i < images; ++i) {
      RenderChoices choices;
      choices.time = step * i;
      const Rendering image = render_text(text_, choices);
      EXPECT_EQ(image.id(1, 1), 1);
      EXPECT_NEAR(image.at("doppler.D", 1, 1) / doppler_, 1.0, 1e-5);
      bright.push_back(image.at("G", 1, 1));
    }
    const auto [least, greatest] = std::minmax_element(bright.begin(), bright.end());
    const double middle = 0.5 * (*least + *greatest);
    std::vector<double> crossings;
    for (std::size_t i = 1; i < bright.size(); ++i) {
      if (bright[i - 1] >= middle || bright[i] < middle) continue;
      const double part = (middle - bright[i - 1]) / (bright[i] - bright[i - 1]);
      crossings.push_back(step / gamma_ * (static_cast<double>(i) - 1.0 + part));
    }
    EXPECT_GT(crossings.size(), 4U);
    return (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  }

 private:
  std::string text_;
  double gamma_ = 1.0;
  double doppler_ = 1.0;
};

void expect_period(const Vec3& towards, const Vec3& velocity) {
  const Film film(glm::normalize(towards), velocity);
  const double period = film.seen_period();
  EXPECT_NEAR(period * film.doppler() / (2.0 * std::numbers::pi), 1.0, 1e-3)
      << "D = " << film.doppler() << ", " << list(towards) << list(velocity);
}

TEST(BlinkingLamp, IsSeenFasterHeadOn) {
  expect_period({0, 0, 1}, {0, 0, 0.6});  // D = 2
}

TEST(BlinkingLamp, IsSeenSlowerFromBehind) {
  expect_period({0, 0, 1}, {0, 0, -0.8});  // D = 1/3
}

TEST(BlinkingLamp, IsSeenFasterTransversely) {
  expect_period({0, 0, 1}, {0.6, 0, 0});  // D = γ = 1.25
}

TEST(BlinkingLamp, IsSeenByTheDopplerFactorObliquely) {
  expect_period({1, -0.5, 2}, {0.3, 0.5, 0.4});
  expect_period({1, -0.5, 2}, {-0.7, 0.2, 0.1});
}

TEST(BlinkingLamp, DoesNotBlinkOtherwiseForACameraAtRest) {
  expect_period({0, 0, 1}, {0, 0, 0});
}

// Towards a ball of whose clock e^(aτ) seconds go by in one of the rocket's: t + x = (e^(aτ) - 1)/a.
TEST(Rocket, SeesTheClockAheadGoExponentially) {
  const std::string text =
      "[film]\nresolution = [3, 3]\naovs = [\"doppler\", \"properTime\"]\n[camera]\ndirection = [0, 0, 1]\n"
      "fov = 1\nrocket = { acceleration = 0.5, along = [0, 0, 1] }\n[[object]]\nshape = \"disk\"\nradius = "
      "20\n"
      "rotate = [90, 0, 0]\nposition = [0, 0, 100]\n";
  for (const double own_time : {0.0, 0.5, 2.0, 5.0, -1.0}) {
    RenderChoices choices;
    choices.time = own_time;
    const Rendering image = render_text(text, choices);
    const double doppler = std::exp(0.5 * own_time);
    EXPECT_NEAR(image.at("doppler.D", 1, 1) / doppler, 1.0, 1e-6);
    EXPECT_NEAR(image.at("properTime.T", 1, 1), (doppler - 1.0) / 0.5 - 100.0, 1e-4);
  }
}

}  // namespace
}  // namespace backlight::test
