// Rays brought next to a surface over lanes: the bits of one ray at a time, for every width.
#include "../../../src/surface/local_lines.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "../../../src/surface/surface_kernels.h"
#include "backlight/base/instruction_sets.h"

namespace backlight {
namespace {

void expect_the_bits_of_one(const SurfaceKernels& kernels, const PlacedSurface& surface) {
  std::mt19937_64 generator(31);
  std::normal_distribution<double> normal;
  auto lines = std::make_unique<LocalLines>();
  lines->count = LocalLines::most;
  for (std::size_t i = 0; i < lines->count; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      lines->origin[axis][i] = normal(generator) * (i % 3 == 0 ? 1e9 : 3.0);
      lines->along[axis][i] = normal(generator) * (i % 4 == 0 ? 1e-3 : 1.0);
    }
    lines->time[i] = normal(generator);
    lines->rate[i] = normal(generator);
  }
  kernels.local_lines(surface.lanes, *lines);
  for (std::size_t i = 0; i < lines->count; ++i) {
    const RestRay ray{{lines->origin[0][i], lines->origin[1][i], lines->origin[2][i]},
                      {lines->along[0][i], lines->along[1][i], lines->along[2][i]},
                      {lines->time[i], lines->rate[i]}};
    const LocalLine one = local_line(ray, surface);
    const LocalLine its = lines->line(i);
    EXPECT_EQ(its.point, one.point) << i;
    EXPECT_EQ(its.direction, one.direction) << i;
    EXPECT_EQ(its.lambda_centre, one.lambda_centre) << i;
    EXPECT_EQ(its.lambda_shift, one.lambda_shift) << i;
    EXPECT_EQ(its.lambda_per_length, one.lambda_per_length) << i;
    EXPECT_EQ(its.clock.start, one.clock.start) << i;
    EXPECT_EQ(its.clock.rate, one.clock.rate) << i;
  }
}

TEST(LocalLines, HaveTheBitsOfOneLine) {
  const Placement moved({3.0, -1.0, 2.0});
  const Placement turned({0.1, 5.0, -2.0}, {20.0, -50.0, 80.0}, {2.0, 0.5, 1.5});
  for (const Placement& placement : {Placement{}, moved, turned}) {
    const PlacedSurface surface = place(torus(2.0, 0.5), placement);
    expect_the_bits_of_one(baseline_surface_kernels(), surface);
#if defined(__x86_64__)
    if (has_avx2()) expect_the_bits_of_one(avx2_surface_kernels(), surface);
    if (has_good_avx512()) expect_the_bits_of_one(avx512_surface_kernels(), surface);
#endif
  }
}

}  // namespace
}  // namespace backlight
