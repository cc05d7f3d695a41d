#include "backlight/colour/spectrum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "backlight/colour/observer.h"

namespace backlight {
namespace {

void expect_colour(const LinearRgb& actual, const LinearRgb& expected, double tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], tolerance) << "component " << c;
}

std::vector<Spectrum> one_of_each() {
  return {Spectrum(),
          Spectrum::constant(0.4),
          Spectrum::reflectance({0.6, 0.25, 0.2}),
          Spectrum::reflectance({0.6, 0.25, 0.2}, 0.05, 0.9),
          Spectrum::illuminant({3.0, 0.2, 7.0}),
          Spectrum::illuminant(LinearRgb{2.0}),
          Spectrum::d65(),
          Spectrum::blackbody(3.0),
          Spectrum::blackbody(300.0),
          Spectrum::blackbody(300.0, 5000.0),
          Spectrum::blackbody(1e9),
          *Spectrum::tabulated({400.0, 500.0, 700.0}, {0.1, 1.0, 0.5}).spectrum};
}

// 2 h c^2 / nm^5 / (exp(h c / (nm k T)) - 1), computed with 40 digits.
TEST(Planck, SpectralRadiance) {
  const auto near = [](double kelvin, double nm, double expected) {
    EXPECT_NEAR(blackbody_radiance(kelvin, nm) / expected, 1.0, 1e-13) << kelvin << " K, " << nm << " nm";
  };
  near(5772.0, 500.0, 26238.5405685958308);
  near(6504.0, 360.0, 42332.915386035337);
  near(300.0, 1e4, 0.00992403333007069467);
  near(300.0, 550.0, 3.19332974179773319e-32);
  near(2856.0, 1e6, 2.35829318002348303e-8);
  near(2.725, 1.063e6, 6.15400487084068689e-13);
  near(1e7, 0.1, 6.72046138613517466e18);
  EXPECT_EQ(blackbody_radiance(300.0, 1e-3), 0.0);
}

TEST(Blackbody, HasThePlanckianShape) {
  for (const double kelvin : {300.0, 2856.0, 6504.0, 30000.0}) {
    const Spectrum body = Spectrum::blackbody(kelvin);
    const double scale = body.at(555.0) / blackbody_radiance(kelvin, 555.0);
    for (const double nm : {200.0, 360.0, 830.0, 1e4, 1e9}) {
      EXPECT_NEAR(body.at(nm) / blackbody_radiance(kelvin, nm) / scale, 1.0, 2e-13) << kelvin << " " << nm;
    }
  }
}

TEST(Blackbody, HasUnitLuminance) {
  for (const double kelvin : {30.0, 300.0, 1000.0, 6504.0, 1e5, 1e9}) {
    EXPECT_NEAR(luminance(film_colour(Spectrum::blackbody(kelvin))), 1.0, 1e-12) << kelvin;
  }
}

// A blackbody seen with a Doppler factor D is a blackbody of D times the temperature, radiance included.
TEST(Blackbody, ShiftsToAnotherTemperature) {
  for (const double doppler : {0.2, 0.9, 1.5, 5.0}) {
    const Spectrum body = Spectrum::blackbody(5000.0);
    const Spectrum shifted = Spectrum::blackbody(5000.0 * doppler, 5000.0);
    for (double nm = 360.0; nm <= 830.0; nm += 10.0) {
      EXPECT_NEAR(std::pow(doppler, 5.0) * body.at(doppler * nm) / shifted.at(nm), 1.0, 1e-13)
          << doppler << " " << nm;
    }
  }
}

TEST(Blackbody, ReferenceKeepsTrueBrightness) {
  const double ratio = Spectrum::blackbody(3000.0, 6000.0).at(600.0) / Spectrum::blackbody(6000.0).at(600.0);
  EXPECT_NEAR(ratio, blackbody_radiance(3000.0, 600.0) / blackbody_radiance(6000.0, 600.0), 1e-13);
}

// 683 lm/W times the sum over 1 nm of the CIE's y times Planck's law, with 50 digits (mpmath).
struct Luminance {
  double kelvin;
  double candelas_per_square_metre;
};
constexpr Luminance luminances[] = {
    {54.5, 2.5658803578379347e-136}, {300.0, 1.029100942717107e-21}, {800.0, 0.0080895312833102014},
    {1000.0, 2.6869636943134825},    {2042.0, 598590.02557013636},   {2856.0, 19749726.161122471},
    {5450.0, 1410856401.292594},     {5772.0, 1843708885.7577571},   {6504.0, 3080221398.3600863},
    {30000.0, 121563048731.20577},   {1e6, 6413153844757.2488},      {1e9, 6498623426670914.0},
    {1e12, 6.4987092770166754e+18}};

TEST(AbsoluteBlackbody, HasItsLuminanceInCandelasPerSquareMetre) {
  for (const Luminance& l : luminances) {
    const double y = luminance(film_colour(Spectrum::absolute_blackbody(l.kelvin)));
    EXPECT_NEAR(y / l.candelas_per_square_metre, 1.0, 1e-10) << l.kelvin << " K";
  }
  EXPECT_EQ(film_colour(Spectrum::absolute_blackbody(2.725)), LinearRgb{0.0});
}

// The film colour with D: docs/physics.md equation (8), the powers of D last.
LinearRgb seen_with(double doppler, const Spectrum& light) {
  const WavelengthSet& set = wavelength_set(400);
  std::vector<double> nm(set.nm().begin(), set.nm().end());
  for (double& at : nm) at *= doppler;
  std::vector<double> values(nm.size());
  light.evaluate_light(nm.data(), set.size(), values.data());
  return std::pow(doppler, 5.0) * set.film(values.data());
}

// Bodies from 1e-6 to 2e6 times as hot, and strengths of any size: what can be said in a float is right.
TEST(AbsoluteBlackbody, IsThatOfTheShiftedTemperatureAtAnyShiftAndStrength) {
  int compared = 0;
  for (const Luminance& l : luminances) {
    for (const double doppler : {1e-6, 1e-3, 0.3, 1.0, 20.0, 2e3, 2e6}) {
      const Spectrum body = Spectrum::absolute_blackbody(l.kelvin / doppler);
      for (const double strength : {1e-300, 1e-150, 1e-9, 1.0, 1e100, 1e150, 1e300}) {
        const LinearRgb seen = seen_with(doppler, body.scaled(strength));
        ASSERT_TRUE(std::isfinite(seen.r) && std::isfinite(seen.g) && std::isfinite(seen.b));
        const double expected = l.candelas_per_square_metre * strength;
        if (!(expected > 1e-45 && expected < 3.4e38)) continue;
        // What 400 wavelengths make of it: the light of 54 K grows by e in 3 nm (2.7e-3), of 300 K in 14 nm
        // (1.7e-5).
        const double quadrature = l.kelvin < 200.0 ? 3e-3 : 3e-5;
        EXPECT_NEAR(luminance(seen) / expected, 1.0, quadrature)
            << l.kelvin << " " << doppler << " " << strength;
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 182);
}

// Of film Y 1 at rest: the coldest and the hottest, seen with any D, and beside each other.
TEST(Blackbody, IsFiniteAndOfItsColourAtAnyTemperatureAndShift) {
  for (double kelvin = 1e-3; kelvin <= 1e12; kelvin *= 31.0) {
    for (double doppler = 1e-6; doppler <= 2e6; doppler *= 7.3) {
      for (const double strength : {1e-300, 1.0, 1e300}) {
        const LinearRgb seen = seen_with(doppler, Spectrum::blackbody(kelvin).scaled(strength));
        ASSERT_TRUE(std::isfinite(seen.r) && std::isfinite(seen.g) && std::isfinite(seen.b));
        const LinearRgb rest = film_colour(Spectrum::blackbody(kelvin * doppler));
        if (!(luminance(seen) > 1e-40) || kelvin * doppler < 40.0) continue;
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(seen[c] / luminance(seen), rest[c] / luminance(rest), 2e-3 * std::abs(rest[0]))
              << kelvin << " K with D = " << doppler << ", " << strength;
        }
      }
    }
  }
}

TEST(Blackbody, BeyondADoubleKeepsItsColour) {
  const LinearRgb seen = seen_with(19.949874, Spectrum::blackbody(2.725).scaled(1e-300));
  const LinearRgb red = seen / seen.r;
  EXPECT_GT(seen.r, 1e200);
  EXPECT_LT(red.g, 0.0);
  EXPECT_LT(std::abs(red.g), 0.2);
  EXPECT_LT(std::abs(red.b), 0.05);
}

TEST(Blackbody, StrengthIsKeptAsALogarithm) {
  EXPECT_NEAR(luminance(film_colour(Spectrum::blackbody(3000.0).scaled(1e-200).scaled(1e200))), 1.0, 1e-10);
  EXPECT_TRUE(Spectrum::blackbody(3000.0).scaled(0.0).is_black());
  EXPECT_EQ(Spectrum::blackbody(3000.0).scaled(0.0).at(600.0), 0.0);
}

TEST(D65, IsTheTable) {
  // CIE 15:2004, table T.1.
  EXPECT_NEAR(Spectrum::d65().at(360.0), 0.466383, 1e-15);
  EXPECT_NEAR(Spectrum::d65().at(450.0), 1.17008, 1e-15);
  EXPECT_NEAR(Spectrum::d65().at(560.0), 1.0, 1e-15);
  EXPECT_NEAR(Spectrum::d65().at(700.0), 0.716091, 1e-15);
  EXPECT_NEAR(Spectrum::d65().at(830.0), 0.603125, 1e-15);
  EXPECT_NEAR(Spectrum::d65().at(452.0), 0.6 * 1.17008 + 0.4 * 1.17410, 1e-14);
}

TEST(D65, IsWhiteOnFilm) {
  expect_colour(film_colour(Spectrum::d65()), LinearRgb{1.0}, 1e-14);
}

TEST(D65, GoesOnAsABlackbody) {
  const Spectrum d65 = Spectrum::d65();
  EXPECT_NEAR(d65.at(360.0 - 1e-9), d65.at(360.0), 1e-10);
  EXPECT_NEAR(d65.at(830.0 + 1e-9), d65.at(830.0), 1e-10);
  const auto planck = [](double nm) { return blackbody_radiance(6504.0, nm); };
  EXPECT_NEAR(d65.at(100.0) / d65.at(360.0), planck(100.0) / planck(360.0),
              1e-13 * planck(100.0) / planck(360.0));
  EXPECT_NEAR(d65.at(1e4) / d65.at(830.0), planck(1e4) / planck(830.0), 1e-13 * planck(1e4) / planck(830.0));
}

TEST(Spectrum, FiniteAndNeverNegative) {
  for (const Spectrum& spectrum : one_of_each()) {
    for (double exponent = -3.0; exponent <= 12.0; exponent += 0.01) {
      const double value = spectrum.at(std::pow(10.0, exponent));
      ASSERT_TRUE(std::isfinite(value)) << exponent;
      ASSERT_GE(value, 0.0) << exponent;
    }
    EXPECT_TRUE(std::isfinite(spectrum.at(std::numeric_limits<double>::min())));
    EXPECT_TRUE(std::isfinite(spectrum.at(std::numeric_limits<double>::max())));
  }
}

TEST(Spectrum, BatchesHaveTheSameBits) {
  std::vector<double> nm{std::numeric_limits<double>::min(), 1e-9, 299.0, 300.0, 345.0};
  for (double at = 200.0; at < 1500.0; at *= 1.01) nm.push_back(at);
  for (double at = 360.0; at <= 830.0; at += 2.5) nm.push_back(at);  // D65's joints among them
  nm.insert(nm.end(), {860.0, 890.0, 1e6, 1e300, std::numeric_limits<double>::max()});
  for (const auto instructions : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::widest}) {
    const SpectralKernels& kernels = spectral_kernels(instructions);
    for (const Spectrum& spectrum : one_of_each()) {
      for (std::size_t n = 1; n <= nm.size(); n = n < 17 ? n + 1 : 3 * n) {
        std::vector<double> values(n + 1, -7.0);
        const double* last = nm.data() + (nm.size() - n);
        spectrum.evaluate(last, static_cast<int>(n), values.data(), kernels);
        for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(values[i], spectrum.at(last[i])) << last[i];
        ASSERT_EQ(values[n], -7.0) << "written past the end by " << kernels.name;
      }
    }
  }
}

// Against an extended-precision power, to the error that base/lane_power.h states.
TEST(Spectrum, SharesAreRaised) {
  std::vector<double> shares{0.0, 0x1p-1022, 1e-300, 1e-20, 1.0 - 0x1p-53, 1.0, 1.0 + 0x1p-52};
  for (double share = 0.001; share < 1.0; share += 0.013) shares.push_back(share);
  const int n = static_cast<int>(shares.size());
  for (const double exponent : {1e-12, 0.001, 0.37, 2.0, 25.5, 4000.0}) {
    std::vector<double> expected = shares;
    spectral_kernels(InstructionSet::baseline).raise(exponent, n, expected.data());
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const long double exact =
          std::pow(static_cast<long double>(shares[i]), static_cast<long double>(exponent));
      const long double logarithm = std::fabs(exponent * std::log2(std::max(shares[i], 1e-308)));
      if (exact < 0x1p-1022L) {
        EXPECT_LE(expected[i], 0x1p-1021) << shares[i] << ' ' << exponent;
      } else {
        EXPECT_LE(std::fabs(expected[i] / exact - 1.0L), (4.0L * logarithm + 8.0L) * 0x1p-53L)
            << shares[i] << ' ' << exponent;
      }
    }
    EXPECT_EQ(expected[0], 0.0);
    for (const auto instructions : {InstructionSet::avx2, InstructionSet::widest}) {
      std::vector<double> raised = shares;
      spectral_kernels(instructions).raise(exponent, n, raised.data());
      EXPECT_EQ(raised, expected);
    }
  }
}

TEST(Spectrum, Scaled) {
  for (const Spectrum& spectrum : one_of_each()) {
    // A blackbody of 3 K has its strength as a logarithm of some thousands.
    const double rounding = spectrum.is_blackbody() ? 4e-12 : 1e-15;
    EXPECT_NEAR(spectrum.scaled(3.0).at(600.0), 3.0 * spectrum.at(600.0),
                rounding * 3.0 * spectrum.at(600.0));
  }
}

TEST(Reflectance, RoundTrip) {
  double sampled_worst = 0.0;
  const WavelengthSet set;
  for (const double r : {0.0, 0.02, 0.5, 0.98, 1.0}) {
    for (const double g : {0.0, 0.1, 0.4, 1.0}) {
      for (const double b : {0.0, 0.03, 0.6, 1.0}) {
        const Spectrum surface = Spectrum::reflectance({r, g, b});
        expect_colour(colour_under_d65(surface), {r, g, b}, 1e-9);
        LinearRgb sampled{0.0};
        for (int i = 0; i < set.size(); ++i) {
          const double nm = set.nm()[static_cast<std::size_t>(i)];
          sampled += surface.at(nm) * Spectrum::d65().at(nm) * set.weight(i);
        }
        sampled_worst = std::max(sampled_worst, delta_e_2000(lab_from_rgb(sampled), lab_from_rgb({r, g, b})));
      }
    }
  }
  EXPECT_LT(sampled_worst, 0.03);
}

TEST(Reflectance, GreysAreConstant) {
  for (const double value : {0.0, 0.18, 1.0}) {
    const Spectrum grey = Spectrum::reflectance(LinearRgb{value});
    for (const double nm : {1.0, 400.0, 800.0, 1e6}) EXPECT_EQ(grey.at(nm), value);
    EXPECT_TRUE(grey.is_grey());
  }
}

TEST(Reflectance, ClampsToWhatIsPossible) {
  EXPECT_EQ(Spectrum::reflectance(LinearRgb{1.7}).at(500.0), 1.0);
  EXPECT_EQ(Spectrum::reflectance(LinearRgb{-0.2}).at(500.0), 0.0);
  EXPECT_EQ(Spectrum::reflectance({2.0, 0.5, 0.5}).at(500.0),
            Spectrum::reflectance({1.0, 0.5, 0.5}).at(500.0));
}

TEST(Reflectance, KeepsItsEndsUnlessToldOtherwise) {
  const Spectrum plain = Spectrum::reflectance({0.8, 0.3, 0.1});
  EXPECT_EQ(plain.at(100.0), plain.at(360.0));
  EXPECT_EQ(plain.at(1e5), plain.at(830.0));

  const Spectrum levelled = Spectrum::reflectance({0.8, 0.3, 0.1}, 0.5, 0.25);
  for (const double nm : {360.0, 500.0, 830.0}) EXPECT_EQ(levelled.at(nm), plain.at(nm));
  EXPECT_NEAR(levelled.at(330.0), 0.5 * (plain.at(360.0) + 0.5), 1e-15);
  EXPECT_NEAR(levelled.at(300.0), 0.5, 1e-15);
  EXPECT_NEAR(levelled.at(10.0), 0.5, 1e-15);
  EXPECT_NEAR(levelled.at(860.0), 0.5 * (plain.at(830.0) + 0.25), 1e-15);
  EXPECT_NEAR(levelled.at(890.0), 0.25, 1e-15);
  EXPECT_NEAR(levelled.at(1e6), 0.25, 1e-15);
}

TEST(Illuminant, HasItsColour) {
  for (const LinearRgb& rgb :
       {LinearRgb{1.0, 0.5, 0.2}, {0.0, 0.0, 4.0}, {300.0, 1.0, 0.0}, {0.0, 1e-3, 1e-3}}) {
    const double most = std::max({rgb.x, rgb.y, rgb.z});
    expect_colour(film_colour(Spectrum::illuminant(rgb)), rgb, 1e-9 * most);
  }
}

TEST(Illuminant, WhiteIsD65) {
  const Spectrum white = Spectrum::illuminant(LinearRgb{2.5});
  EXPECT_TRUE(white.is_d65_shaped());
  for (const double nm : {100.0, 360.0, 555.0, 830.0, 5000.0})
    EXPECT_EQ(white.at(nm), 2.5 * Spectrum::d65().at(nm));
}

TEST(Illuminant, BlackIsDark) {
  EXPECT_EQ(Spectrum::illuminant(LinearRgb{0.0}).at(500.0), 0.0);
  EXPECT_EQ(Spectrum::illuminant({-1.0, 0.0, -3.0}).at(500.0), 0.0);
}

TEST(Tabulated, StraightLinesAndEndValues) {
  const SpectrumOrError made = Spectrum::tabulated({400.0, 500.0, 700.0}, {0.1, 1.0, 0.5});
  ASSERT_TRUE(made.spectrum) << made.error;
  EXPECT_EQ(made.spectrum->at(400.0), 0.1);
  EXPECT_NEAR(made.spectrum->at(425.0), 0.325, 1e-15);
  EXPECT_EQ(made.spectrum->at(500.0), 1.0);
  EXPECT_NEAR(made.spectrum->at(600.0), 0.75, 1e-15);
  EXPECT_EQ(made.spectrum->at(1.0), 0.1);
  EXPECT_EQ(made.spectrum->at(1e9), 0.5);
  EXPECT_EQ(Spectrum::tabulated({555.0}, {0.3}).spectrum->at(123.0), 0.3);
}

TEST(Tabulated, SaysWhatIsWrong) {
  const auto error = [](std::vector<double> nm, std::vector<double> values) {
    const SpectrumOrError made = Spectrum::tabulated(std::move(nm), std::move(values));
    EXPECT_FALSE(made.spectrum);
    return made.error;
  };
  EXPECT_EQ(error({}, {}), "a spectrum needs at least one wavelength");
  EXPECT_EQ(error({400, 500}, {1}),
            "a spectrum needs as many values as wavelengths; there are 2 wavelengths and 1 values");
  EXPECT_EQ(error({400, 400}, {1, 1}), "wavelengths must ascend (number 2)");
  EXPECT_EQ(error({400, 300}, {1, 1}), "wavelengths must ascend (number 2)");
  EXPECT_EQ(error({0}, {1}), "a wavelength must be a positive number of nanometres (number 1)");
  EXPECT_EQ(error({400, 500, 600}, {1, 1, -0.1}), "a spectrum's value must not be negative (number 3)");
  EXPECT_EQ(error({400}, {std::nan("")}), "a spectrum's value must be finite (number 1)");
}

TEST(Spectrum, KnowsWhatItIs) {
  EXPECT_TRUE(Spectrum::constant(0.5).is_grey());
  EXPECT_TRUE(Spectrum::reflectance(LinearRgb{0.5}, 0.5, 0.5).is_grey());
  EXPECT_FALSE(Spectrum::reflectance(LinearRgb{0.5}, 0.1).is_grey());
  EXPECT_FALSE(Spectrum::reflectance({0.5, 0.4, 0.5}).is_grey());
  EXPECT_FALSE(Spectrum::d65().is_grey());
  EXPECT_TRUE(Spectrum::d65().scaled(7.0).is_d65_shaped());
  EXPECT_FALSE(Spectrum::blackbody(6504.0).is_d65_shaped());
  EXPECT_FALSE(Spectrum::illuminant({1.0, 0.9, 1.0}).is_d65_shaped());
  EXPECT_FALSE(Spectrum::constant(1.0).is_d65_shaped());
  EXPECT_TRUE(Spectrum().is_grey());
  EXPECT_TRUE(Spectrum().is_d65_shaped());
}

TEST(ColourUnder, ColouredLightOnAGreySurfaceKeepsItsColour) {
  const LinearRgb amber{1.0, 0.6, 0.1};
  expect_colour(colour_under(Spectrum::illuminant(amber), Spectrum::constant(0.5)), 0.5 * amber, 1e-9);
}

}  // namespace
}  // namespace backlight
