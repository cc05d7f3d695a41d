#include "backlight/colour/light_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>

#include "backlight/colour/observer.h"
#include "backlight/colour/spectrum.h"
#include "cie_sum.h"

namespace backlight {
namespace {

const SpectralKernels& kernels() {
  return spectral_kernels(InstructionSet::widest);
}

// The CIE's sum over 1 nm.
LinearRgb summed(const Spectrum& light, double shift, const Spectrum* surface = nullptr, double d = 1.0) {
  LinearRgb sum{0.0};
  for (int nm = 360; nm <= 830; ++nm) {
    const double reflected = surface == nullptr ? 1.0 : surface->at(d * nm);
    sum += light.at(shift * nm) * reflected * rgb_from_xyz(colour_matching_functions(nm));
  }
  return sum / d65_sum();
}

LinearRgb looked_up(const Spectrum& light, double shift) {
  const WavelengthSet& set = wavelength_set(default_wavelength_count);
  std::vector<double> work(static_cast<std::size_t>(set.size()));
  return set.film_under(light, shift, nullptr, work.data(), kernels());
}

LinearRgb looked_up(const Spectrum& light, double shift, const Spectrum& surface, double d) {
  const WavelengthSet& set = wavelength_set(default_wavelength_count)
                                 .for_steepness(std::max(steepness_of(light), steepness_of(surface)));
  std::vector<double> nm(set.nm().begin(), set.nm().end()), values(nm.size()), work(nm.size());
  for (double& at : nm) at *= d;
  surface.evaluate(nm.data(), set.size(), values.data());
  const WavelengthSet::Sampled sampled{values.data(), &surface, d};
  return set.film_under(light, shift, &sampled, work.data(), kernels());
}

double largest(const LinearRgb& c) {
  return std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)});
}

// Of every channel, relative to itself.
double error_of(const LinearRgb& actual, const LinearRgb& exact) {
  return largest(actual / exact - LinearRgb{1.0});
}

TEST(LightRows, BlackbodiesFromTheColdestToTheHottest) {
  double worst = 0.0;
  for (double kelvin = 30.0; kelvin < 1e9; kelvin *= 1.0137) {
    for (const double shift : {0.3, 1.0, 1.7}) {
      // Of film Y 1 where it is seen.
      const Spectrum body = Spectrum::blackbody(kelvin / shift, kelvin);
      worst = std::max(worst, error_of(looked_up(body, shift), summed(body, shift)));
    }
  }
  EXPECT_LT(worst, 1e-8);
}

TEST(LightRows, BlackbodiesOfFilmLuminanceOne) {
  double worst = 0.0;
  for (double kelvin = 20.0; kelvin < 1e8; kelvin *= 1.0137) {
    const Spectrum exact = Spectrum::blackbody(kelvin), found = LightRows::blackbody(kelvin);
    EXPECT_EQ(found.form().c0, kelvin);
    worst = std::max(worst, std::abs(found.form().c1 - exact.form().c1));
  }
  EXPECT_LT(worst, 1e-8);
}

TEST(LightRows, Daylight) {
  double worst = 0.0;
  for (double shift = 0.15; shift < 6.0; shift *= 1.00171) {
    const Spectrum light = Spectrum::d65();
    const LinearRgb exact = summed(light, shift);
    worst = std::max(worst, largest(looked_up(light, shift) - exact) / largest(exact));
  }
  EXPECT_LT(worst, 3e-4);
  EXPECT_LT(largest(looked_up(Spectrum::d65(), 1.0) - LinearRgb{1.0}), 1e-13);
}

// Channels that are above a tenth of the largest, and above a hundredth: smaller ones are what is left of
// larger ones.
TEST(LightRows, ReflectancesUnderAnyLight) {
  std::mt19937 engine(3);
  const auto unit = [&engine] { return std::uniform_real_distribution<double>(0.0, 1.0)(engine); };
  std::vector<LinearRgb> colours;
  for (int i = 1; i < 7; ++i) colours.emplace_back(i & 1, i >> 1 & 1, i >> 2 & 1);
  for (int i = 0; i < 16; ++i) {
    const double first = unit(), second = unit(), third = unit();
    colours.emplace_back(first, second, third);
    colours.emplace_back(third, second, first);
  }
  std::vector<Spectrum> lights{Spectrum::d65(), Spectrum::illuminant({1.0, 0.3, 0.1})};
  for (const double kelvin : {1000.0, 3000.0, 30000.0}) lights.push_back(Spectrum::blackbody(kelvin));
  double worst = 0.0, worst_own = 0.0, worst_small = 0.0;
  for (const LinearRgb& rgb : colours) {
    const Spectrum surface = Spectrum::reflectance(rgb, rgb.x > 0.8 ? std::optional(0.3) : std::nullopt);
    for (const Spectrum& light : lights) {
      for (double d = 0.25; d < 4.0; d *= 1.13) {
        for (const double shift : {d, 1.0}) {
          const LinearRgb exact = summed(light, shift, &surface, d);
          const LinearRgb off = looked_up(light, shift, surface, d) - exact;
          const double size = largest(exact);
          worst = std::max(worst, largest(off) / size);
          for (int c = 0; c < 3; ++c) {
            const double own = std::abs(off[c] / exact[c]);
            if (std::abs(exact[c]) > 0.1 * size) worst_own = std::max(worst_own, own);
            if (std::abs(exact[c]) > 0.01 * size) worst_small = std::max(worst_small, own);
          }
        }
      }
    }
  }
  EXPECT_LT(worst, 5e-4);
  EXPECT_LT(worst_own, 1e-3);
  EXPECT_LT(worst_small, 3e-3);
}

TEST(LightRows, ColouredLight) {
  double worst = 0.0;
  for (const LinearRgb& rgb : {LinearRgb{1, 0.5, 0.25}, {0, 0.2, 1}, {0.9, 1, 0.1}}) {
    const Spectrum light = Spectrum::illuminant(rgb);
    const WavelengthSet& set = wavelength_set(default_wavelength_count).for_steepness(steepness_of(light));
    std::vector<double> work(static_cast<std::size_t>(set.size()));
    for (double shift = 0.3; shift < 3.0; shift *= 1.07) {
      const LinearRgb exact = summed(light, shift);
      const LinearRgb off = set.film_under(light, shift, nullptr, work.data(), kernels()) - exact;
      worst = std::max(worst, largest(off) / largest(exact));
    }
  }
  EXPECT_LT(worst, 5e-4);
}

// At rest, spectra made from colours show just these: textures' too, whose table is off by some 1e-3.
TEST(WavelengthSetMatch, GivesColoursBackAtRest) {
  std::mt19937 engine(5);
  const auto unit = [&engine] { return std::uniform_real_distribution<double>(0.0, 1.0)(engine); };
  for (const int count : {16, 56, 100}) {
    const WavelengthSet& base = wavelength_set(count);
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i) {
      LinearRgb rgb{unit(), unit(), unit()};
      if (i % 5 == 0) rgb *= 0.01;
      if (i % 7 == 0) rgb[i % 3] *= 0.1;
      const auto [shape, set] = base.upsampled(rgb, 0.0);
      const Spectrum surface = Spectrum::sigmoid_reflectance(shape);
      std::vector<double> values(set->nm().size()), work(values.size());
      surface.evaluate(set->nm().data(), set->size(), values.data());
      const WavelengthSet::Sampled sampled{values.data(), &surface, 1.0};
      const LinearRgb seen = set->film_under(Spectrum::d65(), 1.0, &sampled, work.data(), kernels());
      worst = std::max(worst, largest(seen - rgb) / largest(rgb));
    }
    EXPECT_LT(worst, 1e-6) << count;
  }
}

// Rows that several threads make at once are those that one makes.
TEST(LightRows, AreTheSameFromManyThreads) {
  const WavelengthSet alone(24), shared(24);
  const auto film = [](const WavelengthSet& set, double shift) {
    const std::vector<double> ones(set.nm().size(), 1.0);
    LinearRgb sum{0.0};
    for (const Spectrum& light : {Spectrum::d65(), Spectrum::blackbody(3000.0)}) {
      const LightRows::Place place = *set.lights().at(light, shift);
      sum += place.film() + set.lights().weighting(place).film(ones.data(), nullptr, kernels());
    }
    return sum;
  };
  std::vector<LinearRgb> seen[4];
  {
    std::vector<std::jthread> threads;
    for (auto& colours : seen) {
      threads.emplace_back([&colours, &shared, &film] {
        for (double shift = 0.5; shift < 2.0; shift *= 1.01) colours.push_back(film(shared, shift));
      });
    }
  }
  std::size_t i = 0;
  for (double shift = 0.5; shift < 2.0; shift *= 1.01, ++i) {
    for (const auto& colours : seen) ASSERT_EQ(colours[i], film(alone, shift));
  }
}

}  // namespace
}  // namespace backlight
