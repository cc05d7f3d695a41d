// What is left out of the model for measurements: docs/speed-accuracy.md, chart g.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "rendering.h"

namespace backlight::test {
namespace {

constexpr double beta = 0.5, height = 2.0;

// A ball that flies along x above a floor, lit from straight above; the eye is below the ball, one unit above
// the floor, and looks down.
const std::string flight = R"toml(
[film]
resolution = [161, 161]
[camera]
position = [0, 1, 0]
direction = [0, -1, 0]
up = [0, 0, 1]
fov = 150
[effects]
doppler = false
searchlight = "off"
[[light]]
type = "distant"
direction = [0, -1, 0]
irradiance = 1
[[object]]
shape = "plane"
material = { color = [0.8, 0.8, 0.8] }
[[object]]
shape = "sphere"
radius = 0.3
position = [0, 2, 0]
beta = [0.5, 0, 0]
)toml";

double at_floor(const Rendering& image, double x) {
  const auto point = point_of(image.scene.camera.lens, glm::normalize(Vec3{x, -1.0, 0.0}));
  EXPECT_TRUE(point);
  return image.at("G", static_cast<int>(point->x), static_cast<int>(point->y));
}

// The floor at x is seen at t = -sqrt(1 + x²), and its light left the height of the ball earlier by that
// height: the middle of the shadow is where the ball was then. As if light took no time, where it was at t.
TEST(ModelPieces, WithoutRetardationAShadowIsUnderItsBall) {
  double delayed = -3.0;
  for (int i = 0; i < 100; ++i) delayed = beta * (-std::sqrt(1.0 + delayed * delayed) - height);
  const double now = -beta / std::sqrt(1.0 - beta * beta);
  const Rendering retarded = render_text(flight);
  const Rendering instantaneous = render_text(flight, {.pieces = {.retarded_shadows = false}});
  EXPECT_EQ(at_floor(retarded, delayed), 0.0);
  EXPECT_GT(at_floor(retarded, now), 0.1);
  EXPECT_EQ(at_floor(instantaneous, now), 0.0);
  EXPECT_GT(at_floor(instantaneous, delayed), 0.1);
  for (const double side : {-0.4, 0.4}) {
    EXPECT_GT(at_floor(retarded, delayed + 2.0 * side), 0.1);  // it comes, and is seen longer than it is
    EXPECT_GT(at_floor(instantaneous, now + side), 0.1);
  }
}

TEST(ModelPieces, AtRestShadowsAreWhereTheyAre) {
  std::string rest = flight;
  rest.erase(rest.find("beta = "), 18);
  const Rendering retarded = render_text(rest);
  const Rendering instantaneous = render_text(rest, {.pieces = {.retarded_shadows = false}});
  EXPECT_TRUE(std::ranges::equal(retarded.image.plane(1), instantaneous.image.plane(1)));
}

// Two balls ahead of a camera that flies obliquely: all of the sky is within about 1/gamma of its way.
double difference(double gamma) {
  std::ostringstream text;
  text << "[film]\nresolution = [61, 45]\n[camera]\ngamma = " << gamma
       << "\nalong = [0.3, 0, 1]\ndirection = [0.3, 0, 1]\nfov = " << 200.0 / gamma
       << "\n[effects]\ndoppler = false\nsearchlight = \"off\"\n"
          "[[light]]\ntype = \"distant\"\ndirection = [-0.2, -0.6, 1]\n"
          "[[object]]\nshape = \"sphere\"\nradius = 1\nposition = [2, 0, 1.5]\n"
          "[[object]]\nshape = \"sphere\"\nradius = 1.5\nposition = [-1, 0.5, 3]\n";
  const Rendering with = render_text(text.str());
  const Rendering without = render_text(text.str(), {.pieces = {.robust_arithmetic = false}});
  EXPECT_GT(std::ranges::count_if(with.image.plane(1), [](float g) { return g > 0.0F; }), 100);
  double sum = 0.0;
  for (std::size_t i = 0; i < with.image.plane(1).size(); ++i)
    sum += std::abs(double(with.image.plane(1)[i]) - double(without.image.plane(1)[i]));
  return sum;
}

TEST(ModelPieces, RobustArithmeticIsForLargeGammaAlone) {
  EXPECT_EQ(difference(20.0), 0.0);
  EXPECT_GT(difference(1e8), 1.0);
}

}  // namespace
}  // namespace backlight::test
