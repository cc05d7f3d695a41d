// The data channels "light": what they say must be what pictures show.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "backlight/colour/rgb.h"
#include "rendering.h"

namespace backlight::test {
namespace {

// A ball that passes obliquely at 0.7 c, over a floor that it shades from one lamp of two; a lamp at rest in
// the ball's frame; a part of the film is sky.
std::string scene(const std::string& aovs, const std::string& more) {
  return "[film]\nresolution = [48, 32]\nsamples = 1\naovs = [" + aovs + R"(]
[camera]
position = [0, 3, -8]
look_at = [0, 0.5, 0]
velocity = [0.1, 0, 0.2]
[frame.passing]
velocity = [0.6, 0.1, 0.35]
origin_time = -9
[[object]]
name = "ball"
shape = "sphere"
radius = 1
position = [0, 1.2, 0]
frame = "passing"
material = { color = [0.8, 0.5, 0.2] }
[[object]]
name = "floor"
shape = "disk"
radius = 5
material = { color = [0.3, 0.6, 0.4] }
[[object]]
name = "glow"
shape = "sphere"
radius = 0.5
position = [-3, 0.6, 1]
material = { color = [0, 0, 0], emission = 2 }
[[light]]
type = "point"
position = [2, 6, -2]
intensity = 60
[[light]]
type = "point"
position = [0, 5, -3]
frame = "passing"
intensity = 30
[background]
color = [0.1, 0.2, 0.4]
)" + more;
}

TEST(LightChannels, HaveTheLuminanceOfThePictureWithoutShift) {
  const Rendering shifted = render_text(scene("\"light\", \"objectId\"", ""));
  const Rendering plain = render_text(scene("", "[effects]\ndoppler = false\n"));
  double greatest_change = 0.0;
  for (int y = 0; y < plain.height(); ++y) {
    for (int x = 0; x < plain.width(); ++x) {
      const double expected = luminance(plain.rgb(x, y));
      ASSERT_NEAR(shifted.at("light.Y", x, y), expected, 1e-6 * (1.0 + expected)) << x << ", " << y;
      greatest_change = std::max(greatest_change, std::abs(luminance(shifted.rgb(x, y)) - expected));
    }
  }
  EXPECT_GT(greatest_change, 0.05);  // or the test would not tell the two apart
}

TEST(LightChannels, CountTheLampsThatReachThePoint) {
  // Each lamp's share alone says whether it reaches a point.
  const std::string effects = "[effects]\ndoppler = false\n";
  RenderChoices no_first;
  no_first.overrides = {"light.1.intensity=0"};
  RenderChoices no_second;
  no_second.overrides = {"light.2.intensity=0"};
  const Rendering both = render_text(scene("\"light\", \"objectId\"", effects));
  const Rendering second = render_text(scene("", effects), no_first);
  const Rendering first = render_text(scene("", effects), no_second);
  std::array<int, 4> seen{};
  for (int y = 0; y < both.height(); ++y) {
    for (int x = 0; x < both.width(); ++x) {
      int expected = -1;
      if (both.id(x, y) == 3) expected = 1;  // black but for its own light, whatever shines on it
      if (both.id(x, y) == 1 || both.id(x, y) == 2) {
        expected = (first.rgb(x, y).g > 0.0 ? 1 : 0) + (second.rgb(x, y).g > 0.0 ? 1 : 0);
      }
      const int lamps = static_cast<int>(both.at("light.N", x, y));
      if (both.id(x, y) == 3) {
        ASSERT_GE(lamps, expected) << x << ", " << y;
      } else {
        ASSERT_EQ(lamps, expected) << x << ", " << y;
        ++seen[static_cast<std::size_t>(lamps + 1)];
      }
    }
  }
  for (const int pixels : seen) EXPECT_GT(pixels, 5);
}

}  // namespace
}  // namespace backlight::test
