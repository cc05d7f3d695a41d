#include "backlight/colour/observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "backlight/colour/spectrum.h"
#include "cie_sum.h"

namespace backlight {
namespace {

struct Chromaticity {
  double x, y;
};

Chromaticity chromaticity(const LinearRgb& rgb) {
  const Xyz xyz = xyz_from_rgb(rgb);
  const double sum = xyz.x + xyz.y + xyz.z;
  return {xyz.x / sum, xyz.y / sum};
}

LinearRgb film(const WavelengthSet& set, const Spectrum& spectrum) {
  std::vector<double> samples(static_cast<std::size_t>(set.size()));
  spectrum.evaluate(set.nm().data(), set.size(), samples.data());
  return set.film(samples.data());
}

// CIE 15:2004, table T.4 (rounded there to six decimals).
TEST(Observer, PublishedValues) {
  EXPECT_EQ(colour_matching_functions(555.0).y, 1.0);
  EXPECT_NEAR(colour_matching_functions(450.0).x, 0.336200, 1e-9);
  EXPECT_NEAR(colour_matching_functions(450.0).y, 0.038000, 1e-9);
  EXPECT_NEAR(colour_matching_functions(450.0).z, 1.772110, 1e-9);
  EXPECT_NEAR(colour_matching_functions(600.0).x, 1.062200, 1e-9);
  EXPECT_NEAR(colour_matching_functions(600.0).y, 0.631000, 1e-9);
  EXPECT_NEAR(colour_matching_functions(700.0).x, 0.011359, 5e-7);
}

// The published sums of the 1 nm table: 106.865469, 106.856917, 106.892251.
TEST(Observer, PublishedSums) {
  Xyz sum{0.0};
  for (int nm = 360; nm <= 830; ++nm) sum += colour_matching_functions(nm);
  EXPECT_NEAR(sum.x, 106.865469, 1e-6);
  EXPECT_NEAR(sum.y, 106.856917, 1e-6);
  EXPECT_NEAR(sum.z, 106.892251, 1e-6);
}

TEST(Observer, SeesNothingOutsideTheVisible) {
  for (const double nm : {1e-3, 359.999, 830.001, 1e12})
    EXPECT_EQ(colour_matching_functions(nm), Xyz{0.0}) << nm;
  EXPECT_GT(colour_matching_functions(360.0).y, 0.0);
  EXPECT_GT(colour_matching_functions(830.0).y, 0.0);
}

TEST(WavelengthSet, SpansTheVisibleRange) {
  for (const int count : {4, 16, default_wavelength_count, 471}) {
    const WavelengthSet set(count);
    ASSERT_EQ(set.size(), count);
    EXPECT_EQ(set.nm().front(), visible_begin_nm);
    EXPECT_EQ(set.nm().back(), visible_end_nm);
    for (std::size_t i = 1; i < set.nm().size(); ++i) EXPECT_GT(set.nm()[i], set.nm()[i - 1]);
  }
  EXPECT_THROW(WavelengthSet(3), std::invalid_argument);
}

TEST(WavelengthSet, D65IsWhite) {
  for (const int count : {8, 16, 24, 32, default_wavelength_count, 64, 200}) {
    const LinearRgb white = film(WavelengthSet(count), Spectrum::d65());
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1.0, 1e-14) << count;
  }
}

TEST(WavelengthSet, PositiveRadianceHasPositiveLuminance) {
  const WavelengthSet set;
  for (int i = 0; i < set.size(); ++i)
    EXPECT_GT(luminance(set.weight(i)), 0.0) << set.nm()[static_cast<std::size_t>(i)];
}

// Eight sums, added at the end, with any number of lanes and of wavelengths.
TEST(WavelengthSet, FilmIsTheSumOfTheWeights) {
  for (const int count : {4, 20, 21, 24, 56}) {
    const WavelengthSet set(count);
    std::vector<double> lamp(static_cast<std::size_t>(count));
    std::vector<double> reflectance = lamp;
    LinearRgb one[8]{}, product[8]{};
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      lamp[at] = 0.3 + 0.1 * i;
      reflectance[at] = std::exp(-0.1 * i);
      one[i % 8] += lamp[at] * set.weight(i);
      product[i % 8] += lamp[at] * reflectance[at] * set.weight(i);
    }
    const auto added = [](const LinearRgb(&s)[8]) {
      return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
    };
    EXPECT_EQ(set.film(lamp.data()), added(one));
    for (const auto instructions : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::widest}) {
      const SpectralKernels& kernels = spectral_kernels(instructions);
      EXPECT_EQ(set.film(lamp.data(), kernels), added(one)) << kernels.name << ' ' << count;
      EXPECT_EQ(set.film(lamp.data(), reflectance.data(), kernels), added(product)) << kernels.name;
    }
  }
}

// The equal-energy spectrum: the quotients of the published sums, near 1/3.
TEST(WavelengthSet, EqualEnergy) {
  const Chromaticity fine = chromaticity(film_colour(Spectrum::constant(1.0)));
  EXPECT_NEAR(fine.x, 106.865469 / 320.614637, 1e-8);
  EXPECT_NEAR(fine.y, 106.856917 / 320.614637, 1e-8);
  const Chromaticity sampled = chromaticity(film(WavelengthSet(), Spectrum::constant(1.0)));
  EXPECT_NEAR(sampled.x, fine.x, 1e-4);
  EXPECT_NEAR(sampled.y, fine.y, 1e-4);
}

// The Planckian locus: sums over the 1 nm table of nm^-5 / (exp(c2 / (nm T)) - 1), computed with 25 digits.
TEST(WavelengthSet, PlanckianLocus) {
  struct Exact {
    double kelvin, x, y;
  };
  for (const Exact& e : {Exact{1000.0, 0.652750698, 0.3444616552},
                         {2000.0, 0.5266774866, 0.4132970003},
                         {4000.0, 0.3804395326, 0.3767468236},
                         {6500.0, 0.3135258804, 0.3236283047},
                         {10000.0, 0.2806335721, 0.2882878407},
                         {30000.0, 0.2500704046, 0.2487917969}}) {
    const Chromaticity fine = chromaticity(film_colour(Spectrum::blackbody(e.kelvin)));
    EXPECT_NEAR(fine.x, e.x, 1e-9) << e.kelvin;
    EXPECT_NEAR(fine.y, e.y, 1e-9) << e.kelvin;
    const Chromaticity sampled = chromaticity(film(WavelengthSet(), Spectrum::blackbody(e.kelvin)));
    EXPECT_NEAR(sampled.x, e.x, 1e-4) << e.kelvin;
    EXPECT_NEAR(sampled.y, e.y, 1e-4) << e.kelvin;
  }
}

// CIE illuminant A is the blackbody with c2 / T = 0.01435 m K / 2848 K; CIE 15 gives x = 0.44758, y =
// 0.40745.
TEST(WavelengthSet, IlluminantA) {
  const Chromaticity a = chromaticity(film_colour(Spectrum::blackbody(2848.0 * 0.01438776877 / 0.01435)));
  EXPECT_NEAR(a.x, 0.44758, 2e-5);
  EXPECT_NEAR(a.y, 0.40745, 2e-5);
}

// What a shifted scene asks of the default count: reflectances under a lamp that moves with them, and under
// one at rest to the camera. The exposure shows a white surface beside them as white. docs/colour.md has the
// figures.
class ShiftedColours : public testing::Test {
 protected:
  struct Errors {
    double mean = 0.0;
    double largest = 0.0;
    double largest_at_rest = 0.0;
  };

  static Errors measure(const WavelengthSet& set) {
    std::vector<Spectrum> lamps{Spectrum::d65()};
    for (const double kelvin : {1000.0, 2000.0, 3000.0, 5000.0, 10000.0, 30000.0}) {
      lamps.push_back(Spectrum::blackbody(kelvin));
    }
    const std::vector<LinearRgb> colours{{1, 1, 1},       {0.6, 0.25, 0.2}, {0.2, 0.4, 0.1}, {0.1, 0.2, 0.6},
                                         {0.8, 0.7, 0.2}, {1, 0, 0},        {0, 1, 0},       {0, 0, 1},
                                         {0, 1, 1},       {1, 1, 0}};
    Errors errors;
    int cases = 0;
    for (const Spectrum& lamp : lamps) {
      for (const LinearRgb& colour : colours) {
        const Spectrum surface = Spectrum::reflectance(colour);
        for (const double doppler : {0.2, 0.35, 0.5, 0.7, 0.9, 1.0, 1.1, 1.2, 1.35, 1.5, 1.75, 2.5, 5.0}) {
          for (const double lamp_doppler : {doppler, 1.0}) {
            const double error = difference(set, lamp, surface, doppler, lamp_doppler);
            errors.mean += error;
            errors.largest = std::max(errors.largest, error);
            if (doppler == 1.0) errors.largest_at_rest = std::max(errors.largest_at_rest, error);
            ++cases;
          }
        }
      }
    }
    errors.mean /= cases;
    return errors;
  }

 private:
  static double difference(const WavelengthSet& set, const Spectrum& lamp, const Spectrum& surface,
                           double doppler, double lamp_doppler) {
    LinearRgb exact{0.0}, white{0.0}, sampled{0.0};
    for (int nm = 360; nm <= 830; ++nm) {
      const LinearRgb light = lamp.at(lamp_doppler * nm) * rgb_from_xyz(colour_matching_functions(nm));
      white += light;
      exact += surface.at(doppler * nm) * light;
    }
    for (int i = 0; i < set.size(); ++i) {
      const double nm = set.nm()[static_cast<std::size_t>(i)];
      sampled += surface.at(doppler * nm) * lamp.at(lamp_doppler * nm) * set.weight(i);
    }
    // The tables' sums are per 1 nm; a set is normalised to D65.
    const double exposure = 1.0 / luminance(white);
    return delta_e_2000(lab_from_rgb(exact * exposure), lab_from_rgb(sampled * (exposure * d65_sum())));
  }
};

TEST_F(ShiftedColours, DefaultCountIsNotSeenToErr) {
  const Errors errors = measure(WavelengthSet());
  EXPECT_LT(errors.mean, 0.015);
  EXPECT_LT(errors.largest, 0.3);
  EXPECT_LT(errors.largest_at_rest, 0.04);
}

TEST_F(ShiftedColours, ErrLessWithTwiceTheWavelengths) {
  const Errors errors = measure(WavelengthSet(2 * default_wavelength_count));
  const Errors before = measure(WavelengthSet());
  EXPECT_LT(errors.mean, 0.7 * before.mean);
  EXPECT_LT(errors.largest, 0.7 * before.largest);
}

}  // namespace
}  // namespace backlight
