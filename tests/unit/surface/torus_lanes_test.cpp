// The torus over lanes: the first of the crossings that the quartic has on the whole line, and the same bits
// for every width.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "../../../src/surface/shape_table.h"
#include "../../../src/surface/surface_kernels.h"
#include "backlight/base/instruction_sets.h"

namespace backlight {
namespace {

struct Torus {
  double major, minor;
};

/// Lines through points of the tube and beside it, beginning far off, within the tube and about it.
std::vector<LocalLine> lines_about(const Torus& torus, std::size_t count) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> turn(0.0, 6.283185307179586);
  std::vector<LocalLine> lines;
  while (lines.size() < count) {
    const auto i = lines.size();
    Vec3 d{normal(generator), normal(generator), normal(generator)};
    d /= glm::length(d);
    const double a = turn(generator);
    const double b = turn(generator);
    const double off = torus.minor * (i % 4 == 0 ? 1.0 + 0.1 * normal(generator) : turn(generator) / 6.3);
    const double rho = torus.major + off * std::cos(b);
    const Vec3 through{rho * std::cos(a), off * std::sin(b), rho * std::sin(a)};
    const double at = glm::dot(through, d);
    const double start = i % 3 == 0 ? -100.0 : i % 3 == 1 ? at : 2.0 * normal(generator) * torus.minor;
    lines.push_back({through - at * d, d, 0.0, -start, 1.0, {}});
  }
  return lines;
}

class TorusOverLanes : public testing::TestWithParam<Torus> {};

/// Every 64 of them, padded.
std::vector<LocalLines> batches_of(const std::vector<LocalLine>& lines) {
  std::vector<LocalLines> batches;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i % LocalLines::most == 0) batches.emplace_back();
    batches.back().add(lines[i]);
  }
  return batches;
}

TEST_P(TorusOverLanes, FindsTheFirstOfAllCrossings) {
  const Shape shape = torus(GetParam().major, GetParam().minor);
  const auto lines = lines_about(GetParam(), 3000);
  std::vector<FirstOnLine> found(lines.size());
  std::size_t done = 0;
  for (const LocalLines& batch : batches_of(lines)) {
    methods(shape).first_crossings(shape, batch, 0.0, {found.data() + done, batch.count});
    done += batch.count;
  }
  int hits = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Crossings all = crossings(shape, lines[i], 0.0, Wanted::all);
    int first = 0;
    while (first < all.count && !(lines[i].lambda(all.list[first].t) > 0.0)) ++first;
    const Crossings alone = crossings(shape, lines[i], 0.0, Wanted::first);
    ASSERT_EQ(found[i].t < infinite, first < all.count) << i;
    ASSERT_EQ(alone.count > 0, found[i].t < infinite) << i;
    if (alone.count == 0) continue;
    ++hits;
    EXPECT_EQ(alone.list[0].t, found[i].t) << i;
    EXPECT_NEAR(found[i].t, all.list[first].t, 1e-13) << i;
  }
  EXPECT_GT(hits, 1500);
}

// Whether there is a crossing in front of a place is what the first crossing says.
TEST_P(TorusOverLanes, BlocksWhatTheFirstCrossingIsInFrontOf) {
  const Shape shape = torus(GetParam().major, GetParam().minor);
  const auto lines = lines_about(GetParam(), 1000);
  int blocked = 0, open = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    LocalLines one;
    one.add(lines[i]);
    const Crossings first = crossings(shape, lines[i], 0.0, Wanted::first);
    const double lambda = first.count > 0 ? lines[i].lambda(first.list[0].t) : infinite;
    for (const double end :
         {0.5 * lambda, lambda * (1.0 - 1e-9), lambda * (1.0 + 1e-9), 2.0 * lambda, infinite}) {
      bool answer = false;
      methods(shape).blocks(shape, one, 0.0, end, {&answer, 1});
      EXPECT_EQ(answer, lambda < end) << i << " " << end / lambda;
      ++(answer ? blocked : open);
    }
  }
  EXPECT_GT(blocked, 1000);
  EXPECT_GT(open, 1000);
}

TEST_P(TorusOverLanes, HasTheSameBitsForEveryWidth) {
#if defined(__x86_64__)
  if (!has_avx2()) GTEST_SKIP() << "this processor has no AVX2";
  const auto batch = batches_of(lines_about(GetParam(), LocalLines::most)).front();
  const auto roots_by = [&](const SurfaceKernels& kernels, bool any) {
    TorusQuestion question{GetParam().major, GetParam().minor, 0.0, any, any ? 3.0 : infinite};
    std::vector<double> roots(LocalLines::most);
    kernels.torus_roots(question, batch, roots.data());
    return roots;
  };
  for (const bool any : {false, true}) {
    const auto narrow = roots_by(baseline_surface_kernels(), any);
    EXPECT_EQ(roots_by(avx2_surface_kernels(), any), narrow);
    if (has_good_avx512()) {
      EXPECT_EQ(roots_by(avx512_surface_kernels(), any), narrow);
    }
  }
#endif
}

INSTANTIATE_TEST_SUITE_P(Tubes, TorusOverLanes,
                         testing::Values(Torus{1.2, 0.5}, Torus{1.0, 0.25}, Torus{1.0, 0.9},
                                         Torus{1.0, 1e-3}));

}  // namespace
}  // namespace backlight
