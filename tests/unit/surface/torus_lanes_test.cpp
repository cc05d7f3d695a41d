// The torus over lanes: the first of the crossings that the quartic has on the whole line, and the same bits
// for every width.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "../../../src/surface/shape_table.h"
#include "../../../src/surface/torus_lanes.h"
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

TEST_P(TorusOverLanes, FindsTheFirstOfAllCrossings) {
  const Shape shape = torus(GetParam().major, GetParam().minor);
  const auto lines = lines_about(GetParam(), 3000);
  std::vector<Crossings> found(lines.size());
  methods(shape).first_crossings(shape, lines, 0.0, found);
  int hits = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Crossings all = crossings(shape, lines[i], 0.0, Wanted::all);
    int first = 0;
    while (first < all.count && !(lines[i].lambda(all.list[first].t) > 0.0)) ++first;
    const Crossings alone = crossings(shape, lines[i], 0.0, Wanted::first);
    ASSERT_EQ(found[i].count > 0, first < all.count) << i;
    ASSERT_EQ(alone.count, found[i].count) << i;
    if (found[i].count == 0) continue;
    ++hits;
    EXPECT_EQ(alone.list[0].t, found[i].list[0].t) << i;
    EXPECT_NEAR(found[i].list[0].t, all.list[first].t, 1e-13) << i;
  }
  EXPECT_GT(hits, 1500);
}

TEST_P(TorusOverLanes, HasTheSameBitsForEveryWidth) {
#if defined(__x86_64__)
  if (!has_avx2()) GTEST_SKIP() << "this processor has no AVX2";
  const auto lines = lines_about(GetParam(), TorusLines::most);
  TorusLines wide;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      wide.point[axis][k] = lines[k].point[axis];
      wide.direction[axis][k] = lines[k].direction[axis];
    }
    wide.start[k] = -lines[k].lambda_shift;
  }
  TorusLines narrow = wide;
  TorusLines widest = wide;
  torus_roots_avx2(wide, lines.size(), GetParam().major, GetParam().minor);
  torus_roots_baseline(narrow, lines.size(), GetParam().major, GetParam().minor);
  for (std::size_t k = 0; k < lines.size(); ++k) EXPECT_EQ(wide.root[k], narrow.root[k]) << k;
  if (!has_good_avx512()) return;
  torus_roots_avx512(widest, lines.size(), GetParam().major, GetParam().minor);
  for (std::size_t k = 0; k < lines.size(); ++k) EXPECT_EQ(wide.root[k], widest.root[k]) << k;
#endif
}

INSTANTIATE_TEST_SUITE_P(Tubes, TorusOverLanes,
                         testing::Values(Torus{1.2, 0.5}, Torus{1.0, 0.25}, Torus{1.0, 0.9},
                                         Torus{1.0, 1e-3}));

}  // namespace
}  // namespace backlight
