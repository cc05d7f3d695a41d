#include "backlight/colour/reflected_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace backlight {
namespace {

double largest(const LinearRgb& c) {
  return std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)});
}

// Colours of every kind under lights of every kind, each with its set.
class Pairs {
 public:
  Pairs() {
    std::mt19937 engine(11);
    const auto unit = [&engine] { return std::uniform_real_distribution<double>(0.0, 1.0)(engine); };
    lights_ = {Spectrum::d65(), Spectrum::illuminant({1.0, 0.3, 0.1}), Spectrum::illuminant({0.0, 0.2, 1.0})};
    for (const double kelvin : {1200.0, 3000.0, 30000.0}) lights_.push_back(Spectrum::blackbody(kelvin));
    for (int i = 1; i < 7; ++i) add({i & 1, i >> 1 & 1, i >> 2 & 1});
    for (int i = 0; i < 10; ++i) {
      const double red = unit(), green = unit(), blue = unit();
      add({red, green, blue});
    }
    std::uint64_t number = 0;
    for (const Spectrum& light : lights_) {
      for (const Spectrum& surface : surfaces_) {
        const double steepness = std::max(steepness_of(light), steepness_of(surface));
        all_.push_back(
            {++number, &light, &surface, &wavelength_set(default_wavelength_count).for_steepness(steepness)});
      }
    }
  }
  [[nodiscard]] const std::vector<ReflectedLight::Pair>& all() const { return all_; }

 private:
  void add(const LinearRgb& rgb) {
    surfaces_.push_back(Spectrum::reflectance(rgb, rgb.x > 0.8 ? std::optional(0.3) : std::nullopt));
  }
  std::vector<Spectrum> lights_, surfaces_;
  std::vector<ReflectedLight::Pair> all_;
};

const SpectralKernels& kernels() {
  return spectral_kernels(InstructionSet::widest);
}

LinearRgb worked_out(const ReflectedLight::Pair& pair, double doppler, double lamp_doppler) {
  std::vector<double> nm(pair.set->nm().begin(), pair.set->nm().end()), values(nm.size()), work(nm.size());
  for (double& at : nm) at *= doppler;
  pair.reflectance->evaluate(nm.data(), pair.set->size(), values.data(), kernels());
  const WavelengthSet::Sampled sampled{values.data(), pair.reflectance, doppler};
  return pair.set->film_per_luminance(*pair.light, doppler * lamp_doppler, &sampled, work.data(), kernels());
}

TEST(ReflectedLight, FollowsWhatIsWorkedOut) {
  std::mt19937 engine(12);
  std::uniform_real_distribution<double> octaves(-1.5, 1.5);
  ReflectedLight light;
  double worst_gentle = 0.0, worst_steep = 0.0;
  const Pairs pairs;
  for (const ReflectedLight::Pair& pair : pairs.all()) {
    for (int i = 0; i < 60; ++i) {
      const double doppler = std::exp2(octaves(engine));
      const double lamp = i % 3 == 0 ? 1.0 : std::exp2(octaves(engine) / 2.0);
      const LinearRgb exact = worked_out(pair, doppler, lamp);
      const LinearRgb off = light.per_luminance(pair, doppler, lamp, i % 4 == 1, kernels()) - exact;
      double& worst = pair.set->size() == default_wavelength_count ? worst_gentle : worst_steep;
      worst = std::max(worst, largest(off) / largest(exact));
    }
  }
  EXPECT_LT(worst_gentle, 1.5e-4);
  EXPECT_LT(worst_steep, 5e-4);
}

TEST(ReflectedLight, IsExactAtNodes) {
  ReflectedLight light;
  const Pairs pairs;
  for (const ReflectedLight::Pair& pair : pairs.all()) {
    EXPECT_EQ(light.per_luminance(pair, 1.0, 1.0, false, kernels()), worked_out(pair, 1.0, 1.0));
    EXPECT_EQ(light.per_luminance(pair, 0.625, 0.7123, true, kernels()), worked_out(pair, 0.625, 0.7123));
  }
}

// Whatever was asked before, in whatever order, and by whichever instructions.
TEST(ReflectedLight, HasTheSameBitsWhateverIsRemembered) {
  const Pairs pairs;
  struct Question {
    const ReflectedLight::Pair* pair;
    double doppler, lamp;
  };
  std::vector<Question> questions;
  std::mt19937 engine(13);
  std::uniform_real_distribution<double> octaves(-1.0, 1.0);
  for (int i = 0; i < 400; ++i) {
    questions.push_back({&pairs.all()[engine() % pairs.all().size()], std::exp2(octaves(engine)),
                         std::exp2(octaves(engine))});
  }
  ReflectedLight forward, backward, two_lanes;
  std::vector<LinearRgb> seen, seen_by_two;
  const auto ask = [](ReflectedLight& light, const Question& q, const SpectralKernels& by) {
    return light.per_luminance(*q.pair, q.doppler, q.lamp, false, by);
  };
  for (const Question& q : questions) {
    seen.push_back(ask(forward, q, kernels()));
    seen_by_two.push_back(ask(two_lanes, q, spectral_kernels(InstructionSet::baseline)));
  }
  for (std::size_t i = questions.size(); i-- > 0;) {
    EXPECT_EQ(ask(backward, questions[i], kernels()), seen[i]);
    EXPECT_EQ(seen_by_two[i], seen[i]);
  }
}

}  // namespace
}  // namespace backlight
