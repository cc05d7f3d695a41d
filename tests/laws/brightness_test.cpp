// Brightness and colour on rendered images: docs/physics.md section 3 and 7.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "rendering.h"
#include "worst.h"

namespace backlight::test {
namespace {

constexpr double pi = std::numbers::pi;

// An equirectangular camera that moves with velocity v in no special direction through a uniform bath.
std::string bath(const std::string& background, const std::string& effects, const std::string& motion) {
  return film(96, 48) +
         "[camera]\nposition = [0, 0, 0]\ndirection = [0.2, 0.3, 1]\nprojection = \"equirectangular\"\n" +
         motion + "\n[background]\n" + background + "\n[effects]\n" + effects + "\n";
}

// ∫ f dΩ over the whole sky.
template <class F>
double over_the_sky(const Rendering& r, const F& f) {
  double sum = 0.0;
  for (int y = 0; y < r.height(); ++y) {
    const double edge = pi / r.height();
    const double strip = std::cos(edge * y) - std::cos(edge * (y + 1));
    for (int x = 0; x < r.width(); ++x) sum += f(x, y) * strip * 2.0 * pi / r.width();
  }
  return sum;
}

TEST(UniformBath, HasTheEnergyDensityOfTheMovingCamera) {
  const double v2 = 0.36 + 0.04 + 0.09;
  const double gamma2 = 1.0 / (1.0 - v2);
  const Rendering r = render_text(bath("color = [1, 1, 1]", "doppler = false", "beta = [0.6, 0.2, -0.3]"));
  const double energy = over_the_sky(r, [&](int x, int y) { return r.rgb(x, y).g; }) / (4.0 * pi);
  EXPECT_NEAR(energy, gamma2 * (1.0 + v2 / 3.0), 2e-3 * energy);
}

TEST(UniformBath, SolidAngleIsOnlyDealtAnew) {
  const Rendering r = render_text(bath("color = [1, 1, 1]", "doppler = false", "beta = [0.1, -0.5, 0.4]"));
  const double sum = over_the_sky(r, [&](int x, int y) { return std::pow(r.at("doppler.D", x, y), 2.0); });
  EXPECT_NEAR(sum, 4.0 * pi, 2e-3 * 4.0 * pi);
}

TEST(UniformBath, EverySwitchIsItsOwnFactor) {
  const std::string motion = "beta = [0.5, 0.4, -0.3]";
  const double gamma = 1.0 / std::sqrt(1.0 - 0.5);
  struct Case {
    const char* effects;
    double (*factor)(double d, double gamma);
  };
  const Case cases[] = {
      {"doppler = false", [](double d, double) { return d * d * d * d; }},
      {"doppler = false\nsearchlight = \"paper\"", [](double d, double g) { return g * d * d * d; }},
      {"doppler = false\nsearchlight = \"off\"", [](double, double) { return 1.0; }},
      {"doppler = false\nsearchlight = \"off\"\nenergy = true", [](double d, double) { return d; }},
      {"doppler = false\nsearchlight = \"off\"\nrate = \"exact\"", [](double d, double) { return d; }},
      {"doppler = false\nsearchlight = \"off\"\nrate = \"dilation\"", [](double, double g) { return g; }},
      {"doppler = false\nsearchlight = \"off\"\nsolid_angle = true", [](double d, double) { return d * d; }},
      {"doppler = false\nsolid_angle = false", [](double d, double) { return d * d; }},
      {"doppler = false\nlight_delay = false", [](double, double) { return 1.0; }},
  };
  for (const Case& c : cases) {
    const Rendering r = render_text(bath("color = [0.5, 0.25, 1]", c.effects, motion));
    for (int y = 3; y < r.height(); y += 7) {
      for (int x = 2; x < r.width(); x += 11) {
        const double f = c.factor(r.at("doppler.D", x, y), gamma);
        EXPECT_NEAR(r.rgb(x, y).b, f, 1e-6 * f) << c.effects;
        EXPECT_NEAR(r.rgb(x, y).r, 0.5 * f, 1e-6 * f) << c.effects;
      }
    }
  }
}

TEST(BlackbodyBath, IsABlackbodyOfTheShiftedTemperatureAtEveryAngle) {
  const std::string motion = "beta = [0.3, 0.5, 0.2]";
  const Rendering moving = render_text(bath("temperature = 5000", "", motion));
  int compared = 0;
  for (int y = 2; y < moving.height(); y += 9) {
    for (int x = 1; x < moving.width(); x += 13) {
      const double d = moving.at("doppler.D", x, y);
      std::ostringstream temperature;
      temperature.precision(17);
      // A bath at rest of temperature DT, with the brightness that Planck's law gives it relative to T.
      temperature << "temperature = " << 5000.0 * d;
      const Rendering rest =
          render_text(bath(temperature.str(), "", "velocity = [0, 0, 0]"), {.wavelengths = 400});
      const Vec3 a = moving.rgb(x, y);
      const Vec3 b = rest.rgb(0, 0);
      // Same chromaticity.
      EXPECT_NEAR(a.r / (a.r + a.g + a.b), b.r / (b.r + b.g + b.b), 2e-4) << "D = " << d;
      EXPECT_NEAR(a.b / (a.r + a.g + a.b), b.b / (b.r + b.g + b.b), 2e-4) << "D = " << d;
      // Same radiance: Y of the rest bath is normalised to 1, so scale by Planck's law at one wavelength,
      // with both normalised bodies evaluated by the spectrum itself.
      const Spectrum unit = Spectrum::blackbody(5000.0 * d, 5000.0);
      const Vec3 c = film_colour(unit);
      EXPECT_NEAR(a.g, c.g, 2e-4 * c.g) << "D = " << d;
      ++compared;
    }
  }
  EXPECT_GT(compared, 30);
}

TEST(Star, ArrivesAtTheAberratedPlaceWithFluxDSquared) {
  // One star at right angles to the motion; its light over the image times the pixels' solid angles is its
  // flux.
  for (const char* projection : {"perspective", "equirectangular", "mercator", "fisheye"}) {
    const double v = 0.8;
    const double gamma = 1.0 / 0.6;
    const std::string head =
        film(64, 48) + "[background]\nstars = \"tests/laws/one_star.csv\"\n[effects]\ndoppler = false\n";
    const std::string camera =
        std::string("[camera]\nposition = [0, 0, 0]\nprojection = \"") + projection + "\"\nfov = 120\n";
    const auto flux = [&](const std::string& motion, Vec3& where) {
      const Rendering r = render_text(head + camera + motion);
      double sum = 0.0;
      for (int y = 0; y < r.height(); ++y) {
        for (int x = 0; x < r.width(); ++x) {
          if (r.rgb(x, y).g <= 0.0) continue;
          sum += r.rgb(x, y).g * pixel_solid_angle(r.scene.camera.lens, {x + 0.5, y + 0.5});
          where = r.direction(x, y);
        }
      }
      return sum;
    };
    // Find the star, then look at it from a camera that moves across.
    Vec3 at_rest{0.0};
    Vec3 moving{0.0};
    const double still = flux("direction = [0, 0.1, 1]\n", at_rest);
    ASSERT_GT(still, 0.0) << projection;
    const double seen = flux("direction = [0.5, 0.1, 1]\nbeta = [0.8, 0, 0]\n", moving);
    ASSERT_GT(seen, 0.0) << projection;
    // The star stands at (0, 0, 1): seen at cos = v ahead of the perpendicular, D = γ(1 - v·l) = γ, l ⟂ v.
    EXPECT_NEAR(moving.x, v, 0.06) << projection;
    EXPECT_NEAR(seen / still, gamma * gamma, 1e-6 * gamma * gamma) << projection;
  }
}

TEST(Star, IsHiddenBehindAnObject) {
  const std::string scene = film(64, 48) +
                            "[background]\nstars = \"tests/laws/one_star.csv\"\n"
                            "[camera]\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\n";
  const auto brightest = [](const Rendering& r) {
    double most = 0.0;
    for (int y = 0; y < r.height(); ++y)
      for (int x = 0; x < r.width(); ++x) most = std::max(most, r.rgb(x, y).g);
    return most;
  };
  EXPECT_GT(brightest(render_text(scene)), 0.0);
  EXPECT_EQ(
      brightest(render_text(scene + "[[object]]\nshape = \"sphere\"\nradius = 1\nposition = [0, 0, 9]\n")),
      0.0);
}

TEST(ColourPaths, AgreeAtRest) {
  // The RGB path at rest against the spectral path for the same things with a speed too small to see.
  const std::string scene = film(48, 36) +
                            "[camera]\nposition = [0, 1, -6]\nlook_at = [0, 0, 0]\n"
                            "[[light]]\nposition = [2, 5, -4]\nintensity = 90\ntemperature = 3200\n"
                            "[[light]]\nposition = [-4, 3, -4]\nintensity = 30\ncolor = [0.3, 0.6, 1.0]\n"
                            "[[light]]\ntype = \"ambient\"\nradiance = 0.1\n"
                            "[[object]]\nshape = \"plane\"\nposition = [0, -1, 0]\nmaterial = { checker = { "
                            "colors = [[0.7, 0.2, 0.1], [0.1, 0.5, 0.2]], size = 1 } }\n"
                            "[[object]]\nshape = \"sphere\"\nradius = 1\nmaterial = { color = [0.2, 0.35, "
                            "0.8], specular = 0.2, emission = 0.1, temperature = 2500 }\n";
  const Rendering rgb = render_text(scene);
  const Rendering spectral = render_text(scene, {.wavelengths = default_wavelength_count});
  Worst worst;
  for (int y = 0; y < rgb.height(); ++y) {
    for (int x = 0; x < rgb.width(); ++x) {
      const Vec3 a = rgb.rgb(x, y);
      const double size = glm::length(a);
      if (size > 0.0) worst.take(glm::length(a - spectral.rgb(x, y)) / size);
    }
  }
  EXPECT_GT(worst.compared, 1000);
  EXPECT_LT(worst.error, 2e-3);
}

}  // namespace
}  // namespace backlight::test
