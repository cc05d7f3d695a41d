// What one operation on affine forms is rounded by: of operands without an error of their own, which would
// hide it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../../../src/expression/lane_affine.h"
#include "../../../src/expression/rounding.h"
#include "../../../src/expression/single_lane.h"

namespace backlight {
namespace {

using Form = LaneAffine<SingleLane>;
__extension__ typedef __float128 Quad;

/// Not inlined: nothing of it may move past the change of rounding mode.
template <class Rule>
[[gnu::noinline]] Form rounded_up(const Rule& rule, Form a, Form b) {
  return rule(a, b);
}

Quad at(const Form& f, double place) {
  return Quad(f.centre.number()) + Quad(f.slope.number()) * Quad(place);
}

/// Forms whose exact values have few enough digits for 113 bits.
template <class Rule, class Exact>
void expect_inside(const Rule& rule, const Exact& exact) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  int rounded = 0;
  for (int i = 0; i < 20000; ++i) {
    const double steep = std::ldexp(1.0, -(i % 12));
    const Form a{share(random) / 3.0, steep * share(random) / 7.0, 0.0};
    const Form b{share(random) / 5.0, steep * share(random) / 3.0, 0.0};
    Form result;
    {
      const RoundUp mode;
      result = rounded_up(rule, a, b);
    }
    for (const double place : {-1.0, 1.0, 0.0, 0.5}) {
      const Quad off = exact(at(a, place), at(b, place)) - at(result, place);
      const double distance = std::abs(static_cast<double>(off));
      EXPECT_LE(distance, result.error.number() * (1.0 + 1e-15)) << i << " at " << place;
      rounded += distance > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(rounded, 5000);
}

TEST(AffineRounding, OfSums) {
  expect_inside([](Form a, Form b) { return a + b; }, [](Quad a, Quad b) { return a + b; });
  expect_inside([](Form a, Form b) { return a - b; }, [](Quad a, Quad b) { return a - b; });
}

TEST(AffineRounding, OfConstants) {
  constexpr double number = 0.1;
  expect_inside([](Form a, Form) { return plus_constant(a, SingleLane(number)); },
                [](Quad a, Quad) { return a + Quad(number); });
  expect_inside([](Form a, Form) { return times_constant(a, SingleLane(number)); },
                [](Quad a, Quad) { return a * Quad(number); });
}

// About a point: with slopes of 2⁻⁴⁰ what is not linear is less than the rounding.
TEST(AffineRounding, OfProducts) {
  const auto flat = [](Form a) { return Form{a.centre, a.slope * SingleLane(0x1p-40), SingleLane(0.0)}; };
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    const Form a = flat({share(random), share(random), 0.0});
    const Form b = flat({share(random), share(random), 0.0});
    Form product;
    Form square_of_a;
    {
      const RoundUp mode;
      product = rounded_up([](Form x, Form y) { return x * y; }, a, b);
      square_of_a = rounded_up([](Form x, Form) { return square(x); }, a, b);
    }
    for (const double place : {-1.0, 1.0, 0.0, 0.5}) {
      const double off = static_cast<double>(at(a, place) * at(b, place) - at(product, place));
      EXPECT_LE(std::abs(off), product.error.number() * (1.0 + 1e-15)) << i;
      const double off_square = static_cast<double>(at(a, place) * at(a, place) - at(square_of_a, place));
      EXPECT_LE(std::abs(off_square), square_of_a.error.number() * (1.0 + 1e-15)) << i;
    }
  }
}

}  // namespace
}  // namespace backlight
