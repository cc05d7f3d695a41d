// The bound on what may shade a bundle of light (docs/physics.md equations (17a) and (17b)): it keeps every
// occluder that does, at any speed, and few others.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../../../src/trace/sheet_scene.h"

namespace backlight {
namespace {

using Exact = long double;

struct Exact3 {
  Exact x, y, z;
  friend Exact3 operator+(Exact3 a, Exact3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Exact3 operator*(Exact s, Exact3 a) { return {s * a.x, s * a.y, s * a.z}; }
};

Exact dot(Exact3 a, Exact3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

Exact3 unit(Exact3 a) {
  return (1 / std::sqrt(dot(a, a))) * a;
}

struct Photon {
  Exact3 direction;
  Exact time;
  Exact way;  // to the point that it lights
};

struct Occluder {
  Exact3 celerity;
  Exact gamma;
  Exact radius;
  Exact3 place;
};

class Chance {
 public:
  Exact between(double a, double b) { return std::uniform_real_distribution<>(a, b)(engine_); }
  Exact power_of_ten(double a, double b) { return std::pow(Exact(10), between(a, b)); }
  Exact3 direction() {
    const Exact z = between(-1, 1), angle = between(0, 2 * M_PI), ring = std::sqrt(1 - z * z);
    return {ring * std::cos(angle), ring * std::sin(angle), z};
  }
  // Within `angle` of an axis, on its edge as often as not.
  Exact3 near(Exact3 axis, Exact angle) {
    const Exact3 any = direction();
    const Exact3 aside = unit(any + -dot(any, axis) * axis);
    const Exact off = between(0, 1) < 0.5 ? angle : angle * between(0, 1);
    return std::cos(off) * axis + std::sin(off) * aside;
  }
  Exact3 celerity(Exact most_gamma) {
    const Exact gamma = std::exp(between(0, 1) * std::log(most_gamma));
    return std::sqrt(gamma * gamma - 1) * direction();
  }
  Exact end_or_within(Exact half) {
    return between(0, 1) < 0.5 ? (between(0, 1) < 0.5 ? half : -half) : half * between(-1, 1);
  }

 private:
  std::mt19937 engine_{11};
};

// n + (w·n/(γ+1) - 1) w
Exact3 way_in_frame(const Occluder& o, Exact3 n) {
  return n + (dot(o.celerity, n) / (o.gamma + 1) - 1) * o.celerity;
}

Bundle bundle_of(Exact3 axis, Exact angle, Exact time, Exact half_time, Exact reach) {
  Bundle bundle;
  const Exact a[3] = {axis.x, axis.y, axis.z};
  for (int k = 0; k < 3; ++k) bundle.axis[k] = double(a[k]);
  bundle.cosine = double(std::cos(angle)) - 1e-14;
  bundle.sine = std::sqrt(1.0 - bundle.cosine * bundle.cosine) + 1e-14;
  bundle.time = double(time);
  bundle.half_time = double(half_time) + 1e-14 * double(std::abs(time) + half_time);
  bundle.reach = double(reach);
  return bundle;
}

void add(const Occluder& o, LampTable& table) {
  const auto j = table.count++;
  const Exact w[3] = {o.celerity.x, o.celerity.y, o.celerity.z}, x[3] = {o.place.x, o.place.y, o.place.z};
  for (int k = 0; k < 3; ++k) {
    table.celerity[k][j] = double(w[k]);
    table.place[k][j] = double(x[k]);
  }
  table.gamma[j] = double(o.gamma);
  table.inverse_gamma_plus_one[j] = double(1 / (o.gamma + 1));
  table.speed[j] = double(std::sqrt(dot(o.celerity, o.celerity))) * (1.0 + 1e-15);
  // As of SheetScene: room for the rounding of the place.
  table.radius[j] =
      double(o.radius * (1 + Exact(1e-11)) + Exact(1e-13) * (std::sqrt(dot(o.place, o.place)) + 2 * o.gamma));
  table.core[j] = 0.0;
  table.who[j] = double(j);
}

class LampBundles : public testing::TestWithParam<double> {
 protected:
  // Occluders that touch the way of a photon of the bundle, most of them with their limb.
  Occluder touching(const Photon& photon) {
    Occluder o;
    o.celerity = chance_.celerity(GetParam());
    o.gamma = std::sqrt(1 + dot(o.celerity, o.celerity));
    o.radius = chance_.power_of_ten(-3, 1);
    const Exact3 k = way_in_frame(o, photon.direction);
    const Exact3 any = chance_.direction();
    const Exact depth = chance_.between(0, 1) < 0.5 ? Exact(1 - 1e-9) : chance_.between(0, 1);
    const Exact3 off = depth * o.radius * unit(any + -(dot(any, k) / dot(k, k)) * k);
    o.place = off + (photon.time * o.celerity + -(chance_.between(0, 1) * photon.way) * k);
    return o;
  }

  Chance chance_;
};

TEST_P(LampBundles, KeepWhatShadesTheirLight) {
  constexpr int occluders = 61;
  LampStore all, kept;
  all.resize(occluders);
  kept.resize(occluders);
  for (int trial = 0; trial < 400; ++trial) {
    const Exact3 axis = chance_.direction();
    const Exact angle = chance_.power_of_ten(-5, 0.45), half = chance_.power_of_ten(-5, 2),
                reach = chance_.power_of_ten(-1, 2);
    const Exact time = chance_.between(-30, 30);
    const Bundle bundle = bundle_of(axis, std::min<Exact>(angle, 3), time, half, reach);
    LampTable& table = all.table();
    table.count = 0;
    table.moving = GetParam() > 1.0;
    for (int i = 0; i < occluders; ++i) {
      const Exact way = chance_.between(0, 1) < 0.5 ? reach : reach * chance_.between(0, 1);
      add(touching({chance_.near(axis, std::min<Exact>(angle, 3)), time + chance_.end_or_within(half), way}),
          table);
    }
    for (const InstructionSet set :
         {InstructionSet::widest, InstructionSet::avx2, InstructionSet::baseline}) {
      sheet_kernels(set).overlapping_lamps(table, bundle, kept.table());
      ASSERT_EQ(kept.table().count, occluders) << "trial " << trial << ", " << sheet_kernels(set).name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Gamma, LampBundles, testing::Values(1.0, 3.0, 30.0, 1e3, 1e4));

// Balls all around a lamp that are fast, and so are carried far by the time that a bundle lasts: the bound
// with |w|τ for the lamp's way keeps several times as many.
TEST(LampBundle, LosesLittleToFastOccluders) {
  Chance chance;
  constexpr int occluders = 4000;
  const Exact half = 0.02;
  LampStore all, kept, loose;
  for (LampStore* store : {&all, &kept, &loose}) store->resize(occluders);
  LampTable& table = all.table();
  table.count = 0;
  for (int i = 0; i < occluders; ++i) {
    const Exact gamma = chance.between(10, 30);
    Occluder o{std::sqrt(gamma * gamma - 1) * chance.direction(), gamma, 0.1, {}};
    const Exact3 k = way_in_frame(o, chance.direction());
    o.place = -(5 * chance.between(0.1, 1)) * k;
    add(o, table);
  }
  const SheetKernels& kernels = sheet_kernels(InstructionSet::widest);
  kernels.overlapping_lamps(table, bundle_of(chance.direction(), 0.01, 0, half, 5), kept.table());
  // The same occluders, each as large as that bound has it, for a moment.
  for (int i = 0; i < occluders; ++i) table.radius[i] += table.speed[i] * double(half);
  kernels.overlapping_lamps(table, bundle_of(chance.direction(), 0.01, 0, 0, INFINITY), loose.table());
  EXPECT_LT(8 * kept.table().count, loose.table().count);
  EXPECT_GT(kept.table().count, 0);
}

}  // namespace
}  // namespace backlight
