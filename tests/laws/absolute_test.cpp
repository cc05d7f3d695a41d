// The absolute scale of blackbodies on rendered images: docs/physics.md equation (9a), and its range.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "rendering.h"

namespace backlight::test {
namespace {

std::string text_of(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

// What a body of this temperature shows at rest, of an exposure.
Vec3 shown_at_rest(double kelvin, double exposure) {
  return film_colour(Spectrum::absolute_blackbody(kelvin).scaled(exposure));
}

void expect_colour(const Vec3& seen, const Vec3& expected, double relative) {
  const double size = relative * std::max({std::abs(expected.r), std::abs(expected.g), std::abs(expected.b)});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], expected[c], size) << "component " << c;
}

std::string microwave_background(const std::string& gamma, const std::string& camera,
                                 const std::string& keys = "absolute = true") {
  return film(48, 36) +
         "exposure = 5e-10\n[camera]\nposition = [0, 0, 0]\nalong = [0, 0, 1]\ngamma = " + gamma + "\n" +
         camera + "\n[background]\ntemperature = 2.725\n" + keys + "\n";
}

TEST(MicrowaveBackground, IsBlackAtRestAndAtTheSide) {
  for (const std::string& scene : {microwave_background("1", "fov = 60"),
                                   microwave_background("1000", "direction = [1, 0, 0]\nfov = 60"),
                                   microwave_background("1000", "direction = [0, 0, -1]\nfov = 60")}) {
    const Rendering r = render_text(scene);
    for (int y = 0; y < r.height(); y += 5) {
      for (int x = 0; x < r.width(); x += 5) EXPECT_EQ(r.rgb(x, y), Vec3{0.0});
    }
  }
}

TEST(MicrowaveBackground, GlowsAheadAsTheBlackbodyOfEachDirection) {
  const Rendering r = render_text(microwave_background("1000", "fov = 0.4"));
  int bright = 0;
  for (int y = 0; y < r.height(); y += 2) {
    for (int x = 0; x < r.width(); x += 2) {
      const double kelvin = 2.725 * r.at("doppler.D", x, y);
      const Vec3 expected = shown_at_rest(kelvin, 5e-10);
      if (luminance(expected) < 1e-30) continue;
      expect_colour(r.rgb(x, y), expected, kelvin > 400.0 ? 2e-3 : 2e-2);
      bright += luminance(expected) > 0.1 ? 1 : 0;
    }
  }
  EXPECT_GT(bright, 10);
}

// A sky of 54 K, 10^2600 times as bright as at rest: its colour is kept, and it is told.
TEST(MicrowaveBackground, OfFilmY1IsDeepRedWhereItPassesTheFilm) {
  for (const char* radiance : {"radiance = 1e-300", "radiance = 1", "radiance = 1e300"}) {
    const Rendering r = render_text(microwave_background("10", "fov = 10", radiance));
    EXPECT_EQ(r.statistics.rays.non_finite, 0U);
    const Vec3 rgb = r.rgb(24, 18);
    EXPECT_EQ(rgb.r, std::numeric_limits<float>::max());
    EXPECT_LT(std::abs(rgb.g), 0.2 * rgb.r);
    EXPECT_LT(std::abs(rgb.b), 0.05 * rgb.r);
  }
}

TEST(AbsoluteEmission, IsThatOfTheShiftedTemperatureSlantwiseToo) {
  for (const char* beta : {"[0, 0, 0]", "[0.8, 0, 0]", "[0.5, -0.3, 0.4]", "[0, 0, 0.7]"}) {
    const Rendering r =
        render_text(film(40, 30) +
                    "exposure = 1e-6\n[camera]\nposition = [0, 0, -4]\nfov = 100\n[[object]]\n"
                    "shape = \"sphere\"\nradius = 1.5\nbeta = " +
                    beta + "\nmaterial = { temperature = 2856, absolute = true, emission = 0.5 }\n");
    int seen = 0;
    for (int y = 0; y < r.height(); y += 2) {
      for (int x = 0; x < r.width(); x += 2) {
        if (r.id(x, y) == 0) continue;
        // The surface reflects no light, since there is none.
        expect_colour(r.rgb(x, y), shown_at_rest(2856.0 * r.at("doppler.D", x, y), 0.5e-6), 2e-3);
        ++seen;
      }
    }
    EXPECT_GT(seen, 5) << beta;
  }
}

// White paper under a sun whose frame moves slantwise: E = D^-2 (solid angle) L(DT), D = gamma (1 + v.l).
TEST(AbsoluteLight, OfASolidAngleLightsPaperByItsLuminance) {
  const Vec3 l{0.0, -1.0, 0.0};
  for (const Vec3& v : {Vec3{0.0}, Vec3{0.6, 0.0, 0.0}, Vec3{0.3, 0.5, -0.2}, Vec3{0.1, -0.6, 0.2}}) {
    const double gamma = 1.0 / std::sqrt(1.0 - glm::dot(v, v));
    const double doppler = gamma * (1.0 + glm::dot(v, l));
    const Vec3 travels =
        l + gamma * v +
        (gamma * gamma / (gamma + 1.0)) * glm::dot(v, l) * v;  // times its frequency, 1 in its frame
    const double cosine = -travels.y / glm::length(travels);
    const Rendering r = render_text(
        film(8, 6) +
        "exposure = 1e-5\n[camera]\nposition = [0, 3, 0]\ndirection = [0, -1, 0.1]\n[[object]]\n" +
        "shape = \"plane\"\nmaterial = { color = [1, 1, 1] }\n[[light]]\ntype = \"distant\"\n" +
        "direction = [0, -1, 0]\nirradiance = 6.8e-5\ntemperature = 5772\nabsolute = true\nbeta = [" +
        text_of(v.x) + ", " + text_of(v.y) + ", " + text_of(v.z) + "]\n");
    const double factor = 1e-5 * 6.8e-5 * cosine / (doppler * doppler) / 3.14159265358979324;
    expect_colour(r.rgb(4, 3), factor * shown_at_rest(5772.0 * doppler, 1.0), 2e-3);
  }
}

// At distance r, E = (area shown) L / r^2; a lamp that is far too cold or strong by itself is right all the
// same.
TEST(AbsoluteLight, OfAnAreaLightsPaperByItsLuminance) {
  const auto lit = [](const std::string& keys) {
    return render_text(
        film(8, 6) +
        "[camera]\nposition = [0, 3, 0]\ndirection = [0, -1, 0.001]\n[[object]]\nshape = \"plane\"\n"
        "material = { color = [1, 1, 1] }\n[[light]]\nposition = [0, 2, 0]\n" +
        keys);
  };
  const Rendering glow = lit("intensity = 0.01\ntemperature = 2042\nabsolute = true\n");
  const Vec3 to_lamp = Vec3{0, 2, 0} - glow.position(4, 3);
  const double distance = glm::length(to_lamp);
  const double expected =
      0.01 * 598590.02557013636 * to_lamp.y / (3.14159265358979324 * distance * distance * distance);
  EXPECT_NEAR(luminance(glow.rgb(4, 3)) / expected, 1.0, 1e-5);
  const double one = luminance(lit("intensity = 1\ntemperature = 54.5\n").rgb(4, 3));
  const double cold = luminance(lit("intensity = 1e150\ntemperature = 54.5\nabsolute = true\n").rgb(4, 3));
  EXPECT_NEAR(cold / (one * 2.5658803578379347e14), 1.0, 1e-5);
}

TEST(Exposure, MultipliesTheFilm) {
  const std::string scene =
      "[camera]\nposition = [0, 1, -3]\nbeta = [0.3, 0, 0.2]\n[background]\ncolor = [0.2, 0.5, 1]\n"
      "[[object]]\nshape = \"sphere\"\nradius = 1\nmaterial = { color = [0.7, 0.2, 0.1], emission = 0.1 }\n"
      "[[light]]\nposition = [3, 5, -4]\nintensity = \"40 + t\"\n[[light]]\ntemperature = 2700\nintensity = "
      "5\n"
      "position = [-3, 5, -4]\n";
  const Rendering plain = render_text(film(24, 18) + scene);
  const Rendering exposed = render_text(film(24, 18) + "exposure = 0.25\n" + scene);
  for (int y = 0; y < plain.height(); ++y) {
    for (int x = 0; x < plain.width(); ++x) expect_colour(exposed.rgb(x, y), 0.25 * plain.rgb(x, y), 1e-6);
  }
}

}  // namespace
}  // namespace backlight::test
