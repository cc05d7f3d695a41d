// Lines and narrow tables on rendered images: docs/physics.md equation (13a), with the shifts that the image
// itself says, by this file's own sums.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "backlight/colour/observer.h"
#include "backlight/colour/spectrum.h"
#include "backlight/scene/needs.h"
#include "rendering.h"
#include "worst.h"

namespace backlight::test {
namespace {

LinearRgb film_weight(double nm) {
  static const double d65_sum = [] {
    double y = 0.0;
    for (int at = 360; at <= 830; ++at) y += Spectrum::d65().at(at) * colour_matching_functions(at).y;
    return y;
  }();
  return rgb_from_xyz(colour_matching_functions(nm)) / d65_sum;
}

struct Line {
  double nm;
  double power;
};

const std::vector<Line> sodium{{589.0, 2.0}, {589.6, 1.0}};
const std::vector<Line> hydrogen{
    {410.17, 0.06}, {434.05, 0.17}, {486.13, 0.47}, {656.28, 1.0}, {121.567, 9.0}};

std::string keys(const std::vector<Line>& lines) {
  std::ostringstream nm, power;
  nm.precision(17);
  power.precision(17);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    nm << (i > 0 ? ", " : "") << lines[i].nm;
    power << (i > 0 ? ", " : "") << lines[i].power;
  }
  return "lines = { wavelengths = [" + nm.str() + "], values = [" + power.str() + "] }";
}

// Film of the lines at D, of film Y 1 at rest: D⁴ Σ P w(λ0/D), equation (8), times ρ in the surface's frame.
LinearRgb film_of(const std::vector<Line>& lines, double d, const std::function<double(double)>& reflected) {
  LinearRgb sum{0.0}, at_rest{0.0};
  for (const auto& [nm, power] : lines) {
    sum += power * reflected(nm) * film_weight(nm / d);
    at_rest += power * film_weight(nm);
  }
  return std::pow(d, 4.0) / luminance(at_rest) * sum;
}

double largest(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// All pixels that show anything, beside what `expected` says of each.
double greatest_error(const Rendering& image, const std::function<LinearRgb(int, int)>& expected) {
  Worst worst;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (image.id(x, y) == 0) continue;
      const LinearRgb exact = expected(x, y);
      const double size = largest(exact);
      if (size < 1e-9) {
        EXPECT_LT(largest(image.rgb(x, y)), 1e-8);
        continue;
      }
      worst.take(largest(image.rgb(x, y) - exact) / size);
    }
  }
  EXPECT_GT(worst.compared, 20);
  return worst.error;
}

const std::string ahead = film(16, 12) + "[camera]\nposition = [0, 0, 0]\ndirection = [0, 0, 1]\nfov = 70\n";

TEST(Lines, OfEmissionAtAnyVelocity) {
  for (const auto& lines : {sodium, hydrogen}) {
    for (const char* beta : {"[0, 0, 0.02]", "[0, 0, -0.1]", "[0, 0, 0.078]", "[0.3, 0, 0]", "[0, 0.8, 0]",
                             "[0.3, -0.2, 0.25]", "[-0.1, 0.2, -0.4]", "[1e-10, 0, 0]", "[0, 0, 0]"}) {
      const Rendering image =
          render_text(ahead +
                      "[[object]]\nshape = \"box\"\nsize = [200, 200, 1]\nposition = [0, 0, 9]\n"
                      "beta = " +
                      beta + "\nmaterial = { emission = 1, " + keys(lines) + " }\n");
      EXPECT_LT(greatest_error(image,
                               [&](int x, int y) {
                                 return film_of(lines, image.at("doppler.D", x, y),
                                                [](double) { return 1.0; });
                               }),
                1e-5)
          << beta;
    }
  }
}

// A wall with a lamp that rests on it: one leg shifts.
std::string wall(const std::string& beta, const std::string& material, const std::string& light) {
  return ahead + "[frame.wall]\nbeta = " + beta +
         "\n[[object]]\nshape = \"box\"\nsize = [90, 90, 1]\n"
         "position = [0, 0, 9]\nframe = \"wall\"\nmaterial = { " +
         material +
         " }\n"
         "[[light]]\ntype = \"distant\"\ndirection = [0, 0, 1]\nirradiance = 3.141592653589793\n"
         "frame = \"wall\"\n" +
         light + "\n";
}

TEST(Lines, OfLampsOnWhiteAndColouredWalls) {
  const std::string colours[] = {"color = [1, 1, 1]", "color = [0.9, 0.1, 0.05]"};
  for (const std::string& colour : colours) {
    const Spectrum paint =
        Spectrum::reflectance(colour == colours[0] ? LinearRgb{1.0} : LinearRgb{0.9, 0.1, 0.05});
    for (const char* beta : {"[0, 0, 0.02]", "[0, 0, 0.078]", "[0.3, 0.1, 0]", "[0.2, 0.1, -0.15]"}) {
      const Rendering image = render_text(wall(beta, colour, keys(sodium)));
      EXPECT_LT(greatest_error(image,
                               [&](int x, int y) {
                                 return film_of(sodium, image.at("doppler.D", x, y),
                                                [&](double nm) { return paint.at(nm); });
                               }),
                2e-4)
          << colour << beta;  // the paint's spectrum is matched to its colour
    }
  }
}

// Straight lines, by an own sum over wavelengths of 1/1000 nm.
LinearRgb film_of_triangle(double centre, double half_width, double d,
                           const std::function<double(double)>& reflected) {
  LinearRgb sum{0.0}, at_rest{0.0};
  constexpr int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    const double nm = centre + half_width * (2.0 * (i + 0.5) / steps - 1.0);
    const double power = 1.0 - std::abs(nm - centre) / half_width;
    sum += power * reflected(nm) * film_weight(nm / d);
    at_rest += power * film_weight(nm);
  }
  return std::pow(d, 4.0) / luminance(at_rest) * sum;
}

std::string triangle(double centre, double half_width) {
  std::ostringstream text;
  text.precision(17);
  text << "spectrum = { wavelengths = [" << centre - half_width << ", " << centre << ", "
       << centre + half_width << "], values = [0, 1, 0] }";
  return text.str();
}

TEST(Tables, NarrowLampsOnAWall) {
  for (const double half_width : {0.2, 2.0, 5.0, 10.0, 20.0}) {
    for (const char* beta : {"[0, 0, 0.078]", "[0, 0, 0.0478]", "[0.25, 0, 0]", "[0.2, -0.2, 0.1]"}) {
      const Rendering image = render_text(wall(beta, "color = [1, 1, 1]", triangle(589.0, half_width)));
      EXPECT_LT(greatest_error(image,
                               [&](int x, int y) {
                                 return film_of_triangle(589.0, half_width, image.at("doppler.D", x, y),
                                                         [](double) { return 1.0; });
                               }),
                2e-5)
          << half_width << beta;
    }
  }
}

TEST(Tables, NarrowLampsOnNarrowReflectances) {
  for (const char* beta : {"[0, 0, 0.05]", "[0.4, 0, 0]", "[0.1, 0.3, -0.2]"}) {
    const Rendering image = render_text(wall(beta, triangle(590.0, 1.5), triangle(589.0, 2.0)));
    EXPECT_LT(greatest_error(image,
                             [&](int x, int y) {
                               return film_of_triangle(
                                   589.0, 2.0, image.at("doppler.D", x, y),
                                   [](double nm) { return std::max(0.0, 1.0 - std::abs(nm - 590.0) / 1.5); });
                             }),
              2e-5)
        << beta;
  }
}

// Both legs: a lamp that stays behind while the wall and the camera go their own ways, head-on.
TEST(Lines, ShiftOnBothLegs) {
  const double wall_beta = 0.07;
  const Rendering image = render_text(
      ahead +
      "[[object]]\nshape = \"box\"\nsize = [90, 90, 1]\nposition = [0, 0, 9]\nbeta = [0, 0, 0.07]\n"
      "material = { color = [1, 1, 1] }\n[[light]]\ntype = \"distant\"\ndirection = [0, 0, 1]\n"
      "irradiance = 3.141592653589793\n" +
      keys(sodium) + "\n");
  const double to_wall = std::sqrt((1.0 - wall_beta) / (1.0 + wall_beta));
  EXPECT_LT(greatest_error(image,
                           [&](int x, int y) {
                             const double d = image.at("doppler.D", x, y);
                             // Of a plane wave the flux has two powers of D_j, not four: equation (13).
                             return film_of(sodium, d * to_wall, [](double) { return 1.0; }) /
                                    (to_wall * to_wall);
                           }),
            1e-5);
}

// Just below the speed at which spectra are carried, and just above.
TEST(ColourPaths, MeetWhereMotionBegins) {
  const std::string things =
      "[[light]]\nposition = [2, 5, -4]\nintensity = 90\ntemperature = 3200\nframe = \"f\"\n"
      "[[light]]\nposition = [-4, 3, -4]\nintensity = 30\ncolor = [0.3, 0.6, 1.0]\nframe = \"f\"\n"
      "[[light]]\nposition = [-2, 6, -6]\nintensity = 60\nframe = \"f\"\n"
      "[[light]]\nposition = [3, 2, -6]\nintensity = 40\nframe = \"f\"\n" +
      keys(hydrogen) +
      "\n"
      "[[light]]\nposition = [0, 2, -6]\nintensity = 40\nframe = \"f\"\n" +
      triangle(540.0, 3.0) +
      "\n"
      "[[object]]\nshape = \"plane\"\nposition = [0, -1, 0]\nframe = \"f\"\n"
      "material = { checker = { colors = [[0.7, 0.2, 0.1], [0, 1, 0]], size = 1 } }\n"
      "[[object]]\nshape = \"sphere\"\nradius = 1\nframe = \"f\"\n"
      "material = { color = [0.2, 0.35, 0.8], specular = 0.2, emission = 0.1, temperature = 1000 }\n"
      "[[object]]\nshape = \"sphere\"\nradius = 0.7\nposition = [-1.6, 0, 0]\nframe = \"f\"\n"
      "material = { texture = \"scenes/textures/earth.jpg\", emission = 0.1, emission_color = [1, 0.2, 0.1] "
      "}\n"
      "[[object]]\nshape = \"sphere\"\nradius = 0.6\nposition = [1.6, 0, 0]\nframe = \"f\"\n"
      "material = { spectrum = { wavelengths = [400, 540, 541, 700], values = [0.1, 0.2, 0.9, 0.4] } }\n";
  for (const char* direction : {"[0, 0, 1]", "[1, 0, 0]", "[-0.5, 0.7, 0.5]"}) {
    const auto image = [&](const std::string& speed) {
      return render_text(
          film(48, 36) + "[camera]\nposition = [0, 1, -6]\nlook_at = [0, 0, 0]\n[frame.f]\ncelerity = " +
          speed + "\nalong = " + direction + "\n[background]\ncolor = [0.3, 0.5, 1]\n" + things);
    };
    const Rendering rgb = image("0.9e-9"), spectral = image("1.1e-9");
    ASSERT_FALSE(needs_of(rgb.scene).spectral);
    ASSERT_TRUE(needs_of(spectral.scene).spectral);
    Worst worst;
    for (int y = 0; y < rgb.height(); ++y) {
      for (int x = 0; x < rgb.width(); ++x) {
        if (rgb.id(x, y) != spectral.id(x, y)) continue;
        const Vec3 a = rgb.rgb(x, y), b = spectral.rgb(x, y);
        if (largest(a) == 0.0) {
          EXPECT_EQ(b, a);
          continue;
        }
        for (int c = 0; c < 3; ++c)
          worst.take(std::abs(a[c] - b[c]) / std::max(std::abs(a[c]), 1e-2 * largest(a)));
      }
    }
    EXPECT_GT(worst.compared, 3000);
    EXPECT_LT(worst.error, 1e-5) << direction;
  }
}

}  // namespace
}  // namespace backlight::test
