#include "backlight/colour/upsampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace backlight {
namespace {

double error(const SigmoidReflectance& reflectance, const LinearRgb& rgb) {
  const LinearRgb off = reflected_colour(reflectance) - rgb;
  return std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)});
}

double colour_difference(const SigmoidReflectance& reflectance, const LinearRgb& rgb) {
  return delta_e_2000(lab_from_rgb(reflected_colour(reflectance)), lab_from_rgb(rgb));
}

TEST(SigmoidReflectance, IsTheFormula) {
  // x = 1e-5 500^2 - 0.012 500 + 4 = 0.5; s = 1/2 + 0.25 / sqrt(1.25).
  EXPECT_NEAR((SigmoidReflectance{1e-5, -0.012, 4.0}.at(500.0)), 0.72360679774997897, 1e-15);
}

TEST(SigmoidReflectance, KeepsItsEndValues) {
  const SigmoidReflectance red = fit_sigmoid({0.8, 0.1, 0.1});
  EXPECT_EQ(red.at(1e-3), red.at(360.0));
  EXPECT_EQ(red.at(1e12), red.at(830.0));
}

TEST(FitSigmoid, ReachesTheWholeCube) {
  constexpr int steps = 6;
  for (int r = 0; r <= steps; ++r) {
    for (int g = 0; g <= steps; ++g) {
      for (int b = 0; b <= steps; ++b) {
        const LinearRgb rgb = LinearRgb{r, g, b} / static_cast<double>(steps);
        EXPECT_LT(error(fit_sigmoid(rgb), rgb), 1e-9) << rgb.x << " " << rgb.y << " " << rgb.z;
      }
    }
  }
}

TEST(FitSigmoid, DarkAndLightColours) {
  for (const LinearRgb& hue : {LinearRgb{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, {1.0, 0.3, 0.0}}) {
    for (const double amount : {1e-2, 1e-3, 1e-4}) {
      EXPECT_LT(error(fit_sigmoid(amount * hue), amount * hue), 1e-9);
      const LinearRgb light = LinearRgb{1.0} - amount * hue;
      EXPECT_LT(error(fit_sigmoid(light), light), 1e-9);
    }
  }
}

double largest_of(const LinearRgb& rgb) {
  return std::max({rgb.r, rgb.g, rgb.b});
}

double smallest_of(const LinearRgb& rgb) {
  return std::min({rgb.r, rgb.g, rgb.b});
}

std::vector<LinearRgb> colours_from_black_to_white() {
  std::vector<LinearRgb> colours;
  const double levels[] = {0.0, 1e-9, 0.001, 0.02, 0.2, 0.5, 0.7, 0.98, 1.0};
  for (const double r : levels) {
    for (const double g : levels) {
      for (const double b : levels) colours.push_back({r, g, b});
    }
  }
  return colours;
}

// docs/colour.md, "Bounds": no wavelength is reflected more than twice what the largest component says.
TEST(Reflectance, IsWithinTheBoundsOfItsColourAtEveryWavelength) {
  for (const LinearRgb& rgb : colours_from_black_to_white()) {
    const double most = std::min(1.0, 2.0 * largest_of(rgb));
    const double least = std::max(0.0, 1.0 - 2.0 * (1.0 - smallest_of(rgb)));
    for (const SigmoidReflectance& shape : {fit_sigmoid(rgb), upsample(rgb)}) {
      for (const double nm : {1.0, 360.0, 400.0, 450.0, 520.0, 600.0, 700.0, 780.0, 830.0, 1e9}) {
        EXPECT_LE(shape.at(nm), most * (1.0 + 1e-15)) << rgb.r << " " << rgb.g << " " << rgb.b << ": " << nm;
        EXPECT_GE(shape.at(nm), least * (1.0 - 1e-15) - 1e-16);
      }
    }
  }
}

// Half as dark is the same spectrum, half as high: a shift turns all shades of a dark colour into one hue.
TEST(Reflectance, OfADarkColourIsAShareOfThatOfItsHue) {
  const SigmoidReflectance half = fit_sigmoid({0.5, 0.0, 0.5});
  for (const double share : {0.9, 0.04, 1e-6, 1e-300}) {
    const SigmoidReflectance dark = fit_sigmoid(share * LinearRgb{0.5, 0.0, 0.5});
    for (double nm = 360.0; nm <= 830.0; nm += 10.0)
      EXPECT_NEAR(dark.at(nm), share * half.at(nm), 1e-7 * share) << nm;
  }
}

TEST(FitSigmoid, BlackWhiteAndGreyAreConstant) {
  for (const double nm : {360.0, 550.0, 830.0}) {
    EXPECT_EQ(fit_sigmoid(LinearRgb{0.0}).at(nm), 0.0);
    EXPECT_EQ(fit_sigmoid(LinearRgb{1.0}).at(nm), 1.0);
    EXPECT_NEAR(fit_sigmoid(LinearRgb{0.18}).at(nm), 0.18, 1e-16);
  }
}

TEST(FitSigmoid, ComplementsAddUpToWhite) {
  const SigmoidReflectance colour = fit_sigmoid({0.6, 0.25, 0.2});
  const SigmoidReflectance complement = fit_sigmoid({0.4, 0.75, 0.8});
  for (double nm = 360.0; nm <= 830.0; nm += 10.0) EXPECT_NEAR(colour.at(nm) + complement.at(nm), 1.0, 1e-8);
}

TEST(FitSigmoid, ClampsImpossibleReflectances) {
  const SigmoidReflectance clamped = fit_sigmoid({1.5, 0.5, -0.1});
  const SigmoidReflectance limit = fit_sigmoid({1.0, 0.5, 0.0});
  for (double nm = 360.0; nm <= 830.0; nm += 47.0) EXPECT_EQ(clamped.at(nm), limit.at(nm));
}

// docs/colour.md has the figures: mean 0.020, largest 0.93 over the cube, 2.4 over its faces.
TEST(Upsample, TableIsNear) {
  unsigned state = 7;
  const auto random = [&state] {
    state = state * 1664525u + 1013904223u;
    return (state >> 8) / 16777216.0;
  };
  double sum = 0.0, largest = 0.0;
  int visible = 0;
  constexpr int colours = 4000;
  for (int i = 0; i < colours; ++i) {
    LinearRgb rgb{random(), random(), random()};
    if (i % 2 == 1) rgb[i / 2 % 3] = i / 6 % 2;
    const double difference = colour_difference(upsample(rgb), rgb);
    sum += difference;
    largest = std::max(largest, difference);
    visible += difference > 0.5;
  }
  EXPECT_LT(sum / colours, 0.03);
  EXPECT_LT(largest, 3.0);
  EXPECT_LT(visible, colours / 200);
}

TEST(Upsample, GreysAreExact) {
  for (int i = 0; i <= 255; ++i) {
    const SigmoidReflectance grey = upsample(LinearRgb{i / 255.0});
    EXPECT_EQ(grey.c0, 0.0);
    EXPECT_EQ(grey.c1, 0.0);
    EXPECT_NEAR(grey.at(600.0), i / 255.0, 2.3e-16);
  }
}

// The largest component, the sign of the complement and the table's cells all change over somewhere.
TEST(Upsample, IsContinuousAcrossItsSeams) {
  constexpr double step = 1e-9;
  for (double other = 0.05; other < 1.0; other += 0.1) {
    const auto near = [](const LinearRgb& a, const LinearRgb& b) {
      return delta_e_2000(lab_from_rgb(reflected_colour(upsample(a))),
                          lab_from_rgb(reflected_colour(upsample(b))));
    };
    EXPECT_LT(near({0.6 + step, 0.6, 0.6 * other}, {0.6, 0.6 + step, 0.6 * other}), 0.3) << other;
    EXPECT_LT(
        near({1.0 - 0.5 * other + step, 0.5 * other, 0.5}, {1.0 - 0.5 * other - step, 0.5 * other, 0.5}), 0.3)
        << other;
  }
}

TEST(Upsample, FiniteInTheCornersOfTheCube) {
  for (int corner = 0; corner < 8; ++corner) {
    const LinearRgb rgb{corner & 1, (corner >> 1) & 1, corner >> 2};
    EXPECT_LT(error(upsample(rgb), rgb), 0.002) << corner;
  }
}

TEST(Upsample, DeepestBlacks) {
  for (const LinearRgb& hue : {LinearRgb{1.0, 0.0, 0.5}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.1}}) {
    for (const double amount : {1e-4, 1e-5, 1e-6})
      EXPECT_LT(error(upsample(amount * hue), amount * hue), amount);
    for (const double amount : {1e-12, 1e-20, 1e-29, 1e-31, 1e-300}) {
      EXPECT_LT(error(upsample(amount * hue), LinearRgb{0.0}), 1e-9) << amount;
      EXPECT_LT(error(fit_sigmoid(amount * hue), LinearRgb{0.0}), 1e-7) << amount;
      EXPECT_LT(error(upsample(LinearRgb{1.0} - amount * hue), LinearRgb{1.0}), 1e-9) << amount;
    }
  }
}

}  // namespace
}  // namespace backlight
