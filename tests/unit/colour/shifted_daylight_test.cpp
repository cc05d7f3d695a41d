#include "backlight/colour/shifted_daylight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "backlight/colour/observer.h"
#include "backlight/colour/spectrum.h"

namespace backlight {
namespace {

std::vector<double> directly(const WavelengthSet& set, double shift) {
  std::vector<double> nm(set.nm().begin(), set.nm().end());
  for (double& at : nm) at *= shift;
  std::vector<double> values(nm.size());
  Spectrum::d65().evaluate(nm.data(), set.size(), values.data());
  return values;
}

TEST(ShiftedDaylight, IsD65AtEveryRow) {
  const WavelengthSet set(20);
  for (const double shift : {0.125, 0.5, 1.0, 1.0 + 1.0 / 2048, 2.0, 7.5}) {
    const auto place = set.daylight().at(shift);
    ASSERT_TRUE(place) << shift;
    std::vector<double> values(20);
    place->fill(values.data(), spectral_kernels(InstructionSet::baseline));
    EXPECT_EQ(values, directly(set, shift)) << shift;
    EXPECT_EQ(place->film(), set.film(values.data())) << shift;
  }
}

TEST(ShiftedDaylight, HasItsRange) {
  const WavelengthSet set;
  for (const double shift : {0.0, 1e-300, 0.1249999, 8.0, 1e300, std::nan("")})
    EXPECT_FALSE(set.daylight().at(shift)) << shift;
  EXPECT_TRUE(set.daylight().at(std::nextafter(8.0, 0.0)));
}

// Between the rows, beside the spectrum itself; exposed so that white is of luminance 1. The rule by which
// spectra are sampled is off by 0.009 on average (docs/colour.md).
TEST(ShiftedDaylight, IsNearD65InBetween) {
  const WavelengthSet set;
  const SpectralKernels& kernels = spectral_kernels(InstructionSet::widest);
  double worst = 0.0, sum = 0.0;
  int count = 0;
  for (const LinearRgb& rgb : {LinearRgb{1.0}, {0.9, 0.02, 0.02}, {0.02, 0.9, 0.1}, {0.05, 0.05, 0.9}}) {
    const Spectrum surface = Spectrum::reflectance(rgb);
    std::vector<double> values(56), reflectance(56), nm(56);
    for (const double to_camera : {0.5, 0.8, 1.0, 1.3, 2.0}) {
      for (std::size_t i = 0; i < 56; ++i) nm[i] = to_camera * set.nm()[i];
      surface.evaluate(nm.data(), 56, reflectance.data());
      for (double shift = 0.2; shift < 5.0; shift *= 1.00337) {
        const auto place = set.daylight().at(shift);
        ASSERT_TRUE(place);
        place->fill(values.data(), kernels);
        const std::vector<double> exact = directly(set, shift);
        const double exposure = 1.0 / luminance(set.film(exact.data()));
        const LinearRgb got = exposure * set.film(values.data(), reflectance.data(), kernels);
        const LinearRgb wanted = exposure * set.film(exact.data(), reflectance.data(), kernels);
        const double off = delta_e_2000(lab_from_rgb(got), lab_from_rgb(wanted));
        worst = std::max(worst, off);
        sum += off;
        ++count;
      }
    }
  }
  EXPECT_LT(worst, 0.025);
  EXPECT_LT(sum / count, 2e-4);
}

// Rows that several threads make at once are those that one makes.
TEST(ShiftedDaylight, IsTheSameFromManyThreads) {
  const WavelengthSet alone(24), shared(24);
  std::vector<LinearRgb> seen[4];
  {
    std::vector<std::jthread> threads;
    for (auto& colours : seen) {
      threads.emplace_back([&colours, &shared] {
        for (double shift = 0.5; shift < 2.0; shift *= 1.01)
          colours.push_back(shared.daylight().at(shift)->film());
      });
    }
  }
  std::size_t i = 0;
  for (double shift = 0.5; shift < 2.0; shift *= 1.01, ++i) {
    for (const auto& colours : seen) ASSERT_EQ(colours[i], alone.daylight().at(shift)->film());
  }
}

}  // namespace
}  // namespace backlight
