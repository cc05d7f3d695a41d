// Materials run by the matter's own time: docs/physics.md equation (9b).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "backlight/colour/spectrum.h"
#include "rendering.h"
#include "worst.h"

namespace backlight::test {
namespace {

std::string start(const std::string& params = {}) {
  return "c = 2\n" + params +
         "[film]\nresolution = [40, 40]\naovs = [\"doppler\", \"properTime\", \"objectId\"]\n"
         "[camera]\nposition = [0, 0, -6]\nfov = 40\ntime = 0.7\n"
         "[[light]]\ntype = \"distant\"\ndirection = [0.3, -0.4, 1]\nirradiance = 3\nvelocity = [0.4, 0, "
         "0.6]\n";
}

const std::string at_rest = "position = [0, 0, 0]\n";
/// At 0.9 c, obliquely; its centre is seen where that of the other is.
const std::string moving = "position = [2.76, 1.38, -2.76]\nbeta = [0.6, 0.3, -0.6]\n";

/// On a path, turning: its matter has no common clock.
const std::string swinging = "position = [\"0.6*sin(1.5*t)\", 0.2, 0]\nrotate = [30, \"40*t\", 0]\n";

std::string ball(const std::string& motion, const std::string& material) {
  return "[[object]]\nshape = \"sphere\"\nradius = 1.2\n" + motion + "material = { " + material + " }\n";
}

const RenderChoices three_colours{.overrides = {"effects.doppler=false"}};

bool same_bits(const Rendering& a, const Rendering& b) {
  for (std::size_t channel = 0; channel < a.image.channel_count(); ++channel) {
    const auto x = a.image.plane(channel), y = b.image.plane(channel);
    if (std::memcmp(x.data(), y.data(), x.size_bytes()) != 0) return false;
  }
  return true;
}

/// Calls `at(x, y, own time)` at every pixel of the ball, and returns how far apart the own times are.
template <class At>
double on_the_ball(const Rendering& image, const At& at) {
  double first = 1e300, last = -1e300;
  int pixels = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (image.id(x, y) == 0) continue;
      const double own = image.at("properTime.T", x, y);
      first = std::min(first, own);
      last = std::max(last, own);
      ++pixels;
      at(x, y, own);
    }
  }
  EXPECT_GT(pixels, 150);
  return last - first;
}

constexpr const char* blinking = "emission = \"1.5 + sin(20*t)\", color = [0, 0, 0]";

double blink(double t) {
  return 1.5 + std::sin(20.0 * t);
}

TEST(OwnTime, EmissionIsOfEachPointsOwnTimeTimesDoppler) {
  for (const std::string& motion : {at_rest, moving, swinging}) {
    const Rendering image = render_text(start() + ball(motion, blinking), three_colours);
    Worst error;
    const double spread = on_the_ball(image, [&](int x, int y, double t) {
      const double expected = blink(t) * std::pow(image.at("doppler.D", x, y), 4.0);
      error.take(std::abs(image.at("G", x, y) / expected - 1.0));
    });
    // The channel of the time is a float of some 1e-7: 20 times that in the phase.
    EXPECT_LT(error.error, 2e-5);
    EXPECT_GT(20.0 * spread, 5.0) << "radians of phase over the disc, by the light's way";
  }
}

TEST(OwnTime, ShiftedEmissionIsThatOfTheSteadyOneTimesTheStrength) {
  for (const char* light : {"", "emission_color = [0.9, 0.5, 0.2], ", "temperature = 4000, ",
                            "lines = { wavelengths = [500, 650], values = [1, 2] }, "}) {
    const Rendering image = render_text(start() + ball(moving, light + std::string(blinking)));
    const Rendering steady =
        render_text(start() + ball(moving, light + std::string("emission = 1, color = [0, 0, 0]")));
    Worst error;
    on_the_ball(image, [&](int x, int y, double t) {
      for (const char* channel : {"R", "G", "B"}) {
        const double expected = blink(t) * steady.at(channel, x, y);
        error.take(std::abs(image.at(channel, x, y) - expected) / std::max(std::abs(expected), 0.01));
      }
    });
    // A colour in time is upsampled by the table of textures (docs/colour.md).
    EXPECT_LT(error.error, *light == 'e' ? 0.02 : 2e-5) << light;
  }
}

TEST(OwnTime, TemperatureIsOfEachPointsOwnTimeTimesDoppler) {
  const std::string material =
      "temperature = \"5000 + 2500*sin(6*t)\", absolute = true, emission = 1e-9, color = [0, 0, 0]";
  for (const std::string& motion : {at_rest, moving, swinging}) {
    for (const bool shifted : {true, false}) {
      const Rendering image =
          render_text(start() + ball(motion, material), shifted ? RenderChoices{} : three_colours);
      Worst error;
      on_the_ball(image, [&](int x, int y, double t) {
        const double doppler = image.at("doppler.D", x, y);
        const double kelvin = 5000.0 + 2500.0 * std::sin(6.0 * t);
        const LinearRgb expected =
            shifted ? 1e-9 * film_colour(Spectrum::absolute_blackbody(kelvin * doppler))
                    : 1e-9 * std::pow(doppler, 4.0) * film_colour(Spectrum::absolute_blackbody(kelvin));
        error.take(std::abs(image.at("G", x, y) / expected.g - 1.0));
      });
      EXPECT_LT(error.error, 1e-4) << motion << shifted;
    }
  }
}

// Without `absolute` the emission is the film Y at rest, however hot.
TEST(OwnTime, BodiesOfAnyTemperatureAreAsBrightAsTheyAreSaidToBe) {
  const std::string material = "temperature = \"3000*exp(3*sin(6*t))\", emission = 0.75, color = [0, 0, 0]";
  for (const RenderChoices& choices : {RenderChoices{}, three_colours}) {
    const Rendering image = render_text(start() + ball(at_rest, material), choices);
    Worst error, colour;
    on_the_ball(image, [&](int x, int y, double t) {
      const LinearRgb rgb = image.rgb(x, y);
      error.take(std::abs(luminance(rgb) / 0.75 - 1.0));
      const LinearRgb body = film_colour(Spectrum::blackbody(3000.0 * std::exp(3.0 * std::sin(6.0 * t))));
      colour.take(std::abs(rgb.r / (0.75 * body.r) - 1.0));
    });
    EXPECT_LT(error.error, 2e-6);
    EXPECT_LT(colour.error, 5e-5);
  }
}

// What turns steadily is known to, by how it is written (docs/physics.md equation (25)). With a term that is
// far below rounding it is not, and is integrated.
TEST(OwnTime, OfWhatTurnsIsTheSameHoweverTheAngleIsWritten) {
  const std::string disk =
      "[[object]]\nshape = \"disk\"\nradius = 1.2\nposition = [0.1, 0, 0]\nrotate = [90, 0, A]\n";
  const std::string box = "shape = \"box\"\nsize = [1.2, 0.8, 1]\nscale = [1, 1.5, 0.7]\n";
  const std::string parts = "[[object.part]]\n" + box + "position = [0.4, 0, 0]\nrotate = [10, A, 30]\n" +
                            "[[object.part]]\n" + box + "rotate = [10, 20, A]\n";
  const std::string solid = "[[object]]\nshape = \"union\"\nposition = [0.1, 0, 0]\n";
  for (const std::string& turning :
       {disk, "[[object]]\n" + box + "rotate = [20, A, 40]\n", "[[object]]\n" + box + "rotate = [A, 10, A]\n",
        solid + "rotate = [0, 10, 20]\n" + parts, solid + "scale = [0.5, 1, 1.5]\n" + parts,
        solid + "rotate = [0, A, 0]\n" + parts,
        solid + "rotate = [0, A, 0]\nscale = [0.5, 1, 1.5]\n[[object.part]]\n" + box}) {
    const auto with_angle = [&](const std::string& angle) {
      std::string text = turning;
      for (auto at = text.find("A"); at != std::string::npos; at = text.find("A")) text.replace(at, 1, angle);
      return render_text(start() + text, three_colours);
    };
    const Rendering known = with_angle("\"30 + 40*t\"");
    const Rendering integrated = with_angle("\"30 + 40*t + 1e-30*t^2\"");
    Worst error;
    int pixels = 0;
    for (int y = 0; y < known.height(); ++y) {
      for (int x = 0; x < known.width(); ++x) {
        error.take(std::abs(known.at("properTime.T", x, y) - integrated.at("properTime.T", x, y)));
        pixels += known.id(x, y) != 0;
      }
    }
    EXPECT_GT(pixels, 60) << turning;
    EXPECT_LT(error.error, 2e-6) << turning;
  }
}

TEST(OwnTime, ReflectanceIsOfEachPointsOwnTime) {
  const std::string formula = "\"0.5 + 0.4*sin(9*t)\"";
  const std::string grey = "[" + formula + ", " + formula + ", " + formula + "]";
  for (const std::string& motion : {at_rest, moving, swinging}) {
    for (const RenderChoices& choices : {RenderChoices{}, three_colours}) {
      const Rendering white = render_text(start() + ball(motion, "color = [1, 1, 1]"), choices);
      for (const std::string& material :
           {"color = " + grey, "checker = { colors = [" + grey + ", " + grey + "], size = 0.1 }"}) {
        const Rendering image = render_text(start() + ball(motion, material), choices);
        Worst error;
        double lit = 0.0;
        on_the_ball(image, [&](int x, int y, double t) {
          const double expected = (0.5 + 0.4 * std::sin(9.0 * t)) * white.at("G", x, y);
          lit = std::max(lit, expected);
          error.take(std::abs(image.at("G", x, y) - expected) / std::max(expected, 0.01));
        });
        EXPECT_GT(lit, 0.05);
        EXPECT_LT(error.error, 2e-5) << material;
      }
    }
  }
}

TEST(OwnTime, LobesAreOfEachPointsOwnTime) {
  const std::string grey = "color = [0.5, 0.5, 0.5], shininess = 8, specular = ";
  for (const RenderChoices& choices : {RenderChoices{}, three_colours}) {
    const Rendering none = render_text(start() + ball(moving, grey + "0"), choices);
    const Rendering whole = render_text(start() + ball(moving, grey + "1"), choices);
    const Rendering image = render_text(start() + ball(moving, grey + "\"0.5 + 0.4*sin(9*t)\""), choices);
    Worst error;
    double shining = 0.0;
    on_the_ball(image, [&](int x, int y, double t) {
      const double lobe = whole.at("G", x, y) - none.at("G", x, y);
      const double expected = none.at("G", x, y) + (0.5 + 0.4 * std::sin(9.0 * t)) * lobe;
      shining = std::max(shining, lobe);
      error.take(std::abs(image.at("G", x, y) - expected) / std::max(whole.at("G", x, y), 0.01));
    });
    EXPECT_GT(shining, 0.05);
    EXPECT_LT(error.error, 2e-5);
  }
}

TEST(OwnTime, WhatLeavesItsRangeIsTheNearestEnd) {
  const auto image_of = [](const std::string& material, const RenderChoices& choices = {}) {
    return render_text(start() + ball(moving, material), choices);
  };
  for (const RenderChoices& choices : {RenderChoices{}, three_colours}) {
    const Rendering black = image_of("color = [0, 0, 0]", choices);
    EXPECT_TRUE(same_bits(image_of("emission = \"-1 - t^2\", color = [0, 0, 0]", choices), black));
    const std::string cold = "emission = 1, temperature = \"-300*t^2\", color = [0, 0, 0]";
    EXPECT_TRUE(same_bits(image_of(cold, choices), black));
    EXPECT_TRUE(same_bits(image_of("color = [\"-t^2\", \"-t^2\", \"-t^2\"]", choices), black));
    const Rendering white = image_of("color = [1, 1, 1]", choices);
    EXPECT_TRUE(same_bits(image_of("color = [\"2 + t^2\", \"2 + t^2\", \"2 + t^2\"]", choices), white));
    for (const char* material :
         {"emission = \"log(-1 - t^2)\"", "emission = 1, temperature = \"log(-1 - t^2)\"",
          "emission = 1, emission_color = [1, 1, \"log(-1 - t^2)\"]", "specular = \"log(-1 - t^2)\"",
          "color = [0.2, 0.3, \"log(-1 - t^2)\"]", "ir = \"log(-1 - t^2)\", color = [0.2, 0.3, 0.4]"}) {
      const Rendering image = image_of(material, choices);
      const bool shown = std::strncmp(material, "ir", 2) != 0 || choices.overrides.empty();
      EXPECT_EQ(image.statistics.rays.non_finite > 100, shown) << material;
    }
  }
}

// A name for a part of a formula changes nothing.
TEST(OwnTime, ParametersAreFormulasWhereTheyStand) {
  const std::string params = "[params]\nhalf = 0.5\nw = \"2*clock*half\"\nclock = \"t\"\n";
  const auto named = [&](const std::string& text) {
    std::string written = text;
    for (std::size_t at; (at = written.find('@')) != std::string::npos;) written.replace(at, 1, "w");
    return render_text(start(params) + written);
  };
  const auto plain = [&](const std::string& text) {
    std::string written = text;
    for (std::size_t at; (at = written.find('@')) != std::string::npos;) written.replace(at, 1, "(2*t*0.5)");
    return render_text(start() + written);
  };
  const std::vector<std::string> texts{
      ball(moving, "emission = \"1 + sin(9*@)\""),
      ball(moving, "emission = 1, temperature = \"4000 + 900*sin(@)\""),
      ball(moving, "color = [0.4, \"0.5 + 0.4*sin(9*@)\", 0.1]"),
      ball(moving, "color = [0.4, 0.3, 0.1]") +
          "[[light]]\nposition = [2, 3, -4]\nbeta = [0.1, 0.2, 0.3]\nintensity = \"9 + 5*sin(9*@)\"\n",
      "[[object]]\nshape = \"sphere\"\nradius = 1\nposition = [\"0.6*sin(1.5*@)\", 0, 0]\n"
      "scale = \"1 + 0.1*sin(@)\"\nvisible = \"sin(7*@)\"\n",
      "[[object]]\nshape = \"implicit\"\nf = \"x^2 + y^2 + z^2 - 1\"\nmatter_velocity = [0, "
      "\"0.1*sin(@)\", 0]\n"
      "bounds = [[-2, -2, -2], [2, 2, 2]]\n",
      "[[object]]\nshape = \"implicit\"\nf = \"x^2 + y^2 + z^2 - 1 - 0.3*sin(3*@)\"\n"
      "bounds = [[-2, -2, -2], [2, 2, 2]]\n" +
          moving};
  for (const std::string& text : texts) {
    EXPECT_TRUE(same_bits(named(text), plain(text))) << text;
  }
}

TEST(OwnTime, ImageTimeIsTheImages) {
  const auto image_of = [](const std::string& value) {
    return render_text(start() + ball(moving, "emission = \"1 + " + value + "\"") +
                           "[[light]]\nposition = [2, 3, -4]\nintensity = \"9 + 5*" + value + "\"\n" +
                           "[[object]]\nshape = \"implicit\"\nf = \"x^2 + y^2 + z^2 - 0.3 - 0.3*" + value +
                           "\"\nbounds = [[-2, -2, -2], [2, 2, 2]]\nposition = [-1, -1, 1]\n",
                       {.time = 0.375});
  };
  EXPECT_TRUE(same_bits(image_of("image_time"), image_of("0.375")));
  EXPECT_FALSE(same_bits(image_of("image_time"), image_of("t")));
}

}  // namespace
}  // namespace backlight::test
