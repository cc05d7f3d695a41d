// Bounds proved of formulas: they hold, they are not much too large, and nothing is claimed of what goes on
// forever.
#include "backlight/surface/implicit_surface.h"
#include "formula_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace backlight {
namespace {

ImplicitFormula formula(const std::string& text) {
  return ImplicitFormula(test::formula(text));
}

struct Bounded {
  std::string name;
  std::string f;
  Vec3 lo, hi;  // of the surface, exactly
};

std::ostream& operator<<(std::ostream& out, const Bounded& b) {
  return out << b.name;
}

class ProveBounds : public testing::TestWithParam<Bounded> {};

TEST_P(ProveBounds, EnclosesTheSurfaceTightly) {
  const auto bounds = prove_bounds(formula(GetParam().f));
  ASSERT_TRUE(bounds.has_value());
  EXPECT_FALSE(bounds->inside_beyond);
  const Vec3 size = GetParam().hi - GetParam().lo;
  for (int i = 0; i < 3; ++i) {
    EXPECT_LE(bounds->low[i], GetParam().lo[i]);
    EXPECT_GE(bounds->high[i], GetParam().hi[i]);
    EXPECT_GE(bounds->low[i], GetParam().lo[i] - 0.1 * std::max({size.x, size.y, size.z}));
    EXPECT_LE(bounds->high[i], GetParam().hi[i] + 0.1 * std::max({size.x, size.y, size.z}));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Surfaces, ProveBounds,
    testing::Values(
        Bounded{"sphere", "x^2 + y^2 + z^2 - 1", {-1, -1, -1}, {1, 1, 1}},
        Bounded{"off_centre", "(x-30)^2 + 4*(y+7)^2 + z^2 - 1", {29, -7.5, -1}, {31, -6.5, 1}},
        Bounded{"torus", "(sqrt(x^2 + z^2) - 2)^2 + y^2 - 0.25", {-2.5, -0.5, -2.5}, {2.5, 0.5, 2.5}},
        Bounded{"torus_quartic", "(x^2+y^2+z^2+3.75)^2 - 16*(x^2+z^2)", {-2.5, -0.5, -2.5}, {2.5, 0.5, 2.5}},
        Bounded{"distance", "sqrt(x^2+y^2+z^2) - 1e-3", {-1e-3, -1e-3, -1e-3}, {1e-3, 1e-3, 1e-3}},
        Bounded{"pulsating",
                "x^2 + y^2 + z^2 - (1 + 0.5*sin(t))",
                {-1.2247448, -1.2247448, -1.2247448},
                {1.2247448, 1.2247448, 1.2247448}},
        Bounded{"wavy", "x^2 + y^2 + z^2 - 9 + 0*sin(5*x*y)", {-3, -3, -3}, {3, 3, 3}},
        Bounded{"cube", "max(abs(x), abs(y), abs(z)) - 1", {-1, -1, -1}, {1, 1, 1}}),
    testing::PrintToStringParamName());

TEST(ProveBoundsOf, KleinBottleChmutovAndMetaballs) {
  EXPECT_TRUE(
      prove_bounds(formula("(x^2+y^2+z^2+2*y-1)*((x^2+y^2+z^2-2*y-1)^2-8*z^2)+16*x*z*(x^2+y^2+z^2-2*y-1)")));
  EXPECT_TRUE(prove_bounds(formula("8*x^4-8*x^2+8*y^4-8*y^2+8*z^4-8*z^2+2")));
  EXPECT_TRUE(prove_bounds(formula("x^2+y^2+z^2 + sin(x)*cos(y) + 3*floor(z) - 10")));
}

TEST(ProveBoundsOf, NothingThatGoesOnForever) {
  for (const char* f : {"x^2 + y^2 - 1", "sin(x)*cos(y)+sin(y)*cos(z)+sin(z)*cos(x)",
                        "x^2*y^2+y^2*z^2+z^2*x^2-x*y*z", "y", "x^3+y^3+z^3+1-(x+y+z+1)^3",
                        "exp(x) + y^2 + z^2 - 1", "x*0 + 1/0", "sqrt(-1-x^2)", "x^2+y^2+z^2 - t"}) {
    EXPECT_FALSE(prove_bounds(formula(f)).has_value()) << f;
  }
}

TEST(ProveBoundsOf, AHoleInEverything) {
  const auto bounds = prove_bounds(formula("1 - x^2 - y^2 - z^2"));
  ASSERT_TRUE(bounds.has_value());
  EXPECT_TRUE(bounds->inside_beyond);
}

}  // namespace
}  // namespace backlight
