#include "../../../src/surface/implicit_roots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "backlight/surface/surface_set.h"

namespace backlight {
namespace {

ImplicitFormula formula(const std::string& text) {
  const auto parsed = Expression::parse(text, {"x", "y", "z", "t"});
  if (const auto* error = std::get_if<ExpressionError>(&parsed))
    ADD_FAILURE() << text << ": " << error->message;
  return ImplicitFormula(std::get<Expression>(parsed));
}

std::vector<Root> all_roots(const ImplicitFormula& f, const LinePiece& piece) {
  std::vector<Root> roots;
  Root root;
  for (RootWalk walk(f, piece); walk.next(root);) roots.push_back(root);
  return roots;
}

std::vector<Root> along_x(const std::string& text, double from = -2.0, double to = 2.0) {
  return all_roots(formula(text), {{{0, 0, 0, 0}, {1, 0, 0, 0}}, from, to});
}

struct Known {
  std::string f;
  std::vector<double> roots;
};

class SimpleRoots : public testing::TestWithParam<Known> {};

TEST_P(SimpleRoots, AreAllFoundInOrderAndNoOthers) {
  const std::vector<Root> found = along_x(GetParam().f);
  ASSERT_EQ(found.size(), GetParam().roots.size()) << GetParam().f;
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].t, GetParam().roots[i], 4e-16) << GetParam().f;
    EXPECT_EQ(found[i].kind, RootKind::crossing);
    EXPECT_EQ(found[i].sign_before * found[i].sign_after, -1);
  }
}

using std::numbers::pi;
INSTANTIATE_TEST_SUITE_P(
    Formulas, SimpleRoots,
    testing::Values(Known{"x^2 + y^2 + z^2 - 1", {-1.0, 1.0}}, Known{"x*(x-1)*(x+1)", {-1.0, 0.0, 1.0}},
                    Known{"(x-0.3)*(x-0.3-1e-12)", {0.3, 0.3 + 1e-12}},
                    Known{"sin(4*x)", {-0.5 * pi, -0.25 * pi, 0.0, 0.25 * pi, 0.5 * pi}},
                    Known{"cbrt(x)", {0.0}}, Known{"cbrt(1 + cbrt(2.5*x))", {-0.4}}, Known{"log(x)", {1.0}},
                    Known{"sqrt(x) - 0.5", {0.25}}, Known{"exp(1000*x) - 2", {std::log(2.0) / 1000.0}},
                    Known{"abs(x) - 0.5", {-0.5, 0.5}}, Known{"max(x, -x-1)", {-1.0, 0.0}},
                    Known{"mod(x, 1) - 0.5", {-1.5, -0.5, 0.5, 1.5}},
                    Known{"floor(x) + 0.5 - x", {-1.5, -0.5, 0.5, 1.5}}, Known{"1/x - 4", {0.25}},
                    Known{"atan2(x, 1)", {0.0}}, Known{"x^33 - 1", {1.0}},
                    Known{"asin(x) - 1", {std::sin(1.0)}},
                    // Kinks of min, max and abs are no difficulty, nor operands that are alike.
                    Known{"max(x, x) - 0.1", {0.1}}, Known{"min(x, 2*x)", {0.0}},
                    Known{"max(x - 0.3, 3*(x - 0.3))", {0.3}}, Known{"2*x + abs(x) - 0.5*abs(x)", {0.0}},
                    Known{"max(abs(x), max(abs(x), abs(y))) - 0.5", {-0.5, 0.5}},
                    Known{"clamp(x, -0.5, 0.5) - 0.25", {0.25}},
                    // Behind and in front of what is no root.
                    Known{"sin(6*x)/(6*x) - 0.5", {-0.3159157111723302, 0.3159157111723302}},
                    Known{"x/abs(x) - x + 0.5", {-0.5, 1.5}},
                    Known{"x^x - 0.8", {0.09464971086492496, 0.7395336500107104}},
                    Known{"exp(1000*x) - exp(1000*(0.25 - x))", {0.125}}));

class NoRoots : public testing::TestWithParam<std::string> {};

TEST_P(NoRoots, AreInvented) {
  EXPECT_TRUE(along_x(GetParam()).empty());
}

// Poles, jumps and edges of domains change the sign of f without a root; a near miss does not change it.
INSTANTIATE_TEST_SUITE_P(Formulas, NoRoots,
                         testing::Values("1/x", "1/x^3", "1/(x-0.3)", "x^2 + 1e-20", "x^2 + 1e-300",
                                         "floor(x) + 0.5", "x/abs(x)", "log(x) + 5/x^2", "atan2(x, -1)",
                                         "sqrt(x) + 1e-9", "mod(x, 1) + 1e-9", "sqrt(-1 - x^2)",
                                         "tan(x + pi/2)*0 + 1", "asin(x + 3.5) - 1",
                                         // 0/0, in bounds as wide as they may be next to it
                                         "sin(6*x)/(6*x) - 1.5", "(x-0.2)/(x-0.2) - 0.5", "x/abs(x) - 0.5",
                                         "(x-0.3)/abs(x-0.3) + 0.25", "(1-cos(x))/x^2 - 0.8",
                                         // jumps, poles and edges, some at the ends of the line
                                         "mod(x, 0.5) - 0.7", "floor(x) - 0.5", "floor(-x) + 0.5",
                                         "tan(2*x)*0 + 1", "abs(tan(x)) + 0.1",
                                         "atan2(x, -0.5)/3 + 2*x/abs(x)", "sqrt(x) + 0.1", "log(x) - 5",
                                         "acos(x) + 0.1", "x^0.5 + 0.2", "mod(x, 0.5)", "1/x^2", "x^x + 0.1",
                                         "floor(x)*0 + 0.3*x/x",
                                         // beyond doubles there is no value
                                         "exp(1000*(x + 3)) - exp(1000*(x + 3.5))",
                                         "exp(1000*x)/exp(1000*x) - 2", "sin(exp(1000*(x+3)))"));

struct Touching {
  std::string f;
  std::vector<double> roots;
  double width;  // the enclosure must not be wider
};

class MultipleRoots : public testing::TestWithParam<Touching> {};

TEST_P(MultipleRoots, AreFlaggedAndEnclosed) {
  const std::vector<Root> found = along_x(GetParam().f);
  ASSERT_EQ(found.size(), GetParam().roots.size()) << GetParam().f;
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].kind, RootKind::unresolved) << GetParam().f;
    EXPECT_LE(found[i].lower, GetParam().roots[i]);
    EXPECT_GE(found[i].upper, GetParam().roots[i]);
    EXPECT_LE(found[i].upper - found[i].lower, GetParam().width) << GetParam().f;
  }
}

// Factored, a double root is enclosed to rounding. Expanded, the n-th root of rounding is all there is.
INSTANTIATE_TEST_SUITE_P(Formulas, MultipleRoots,
                         testing::Values(Touching{"(x^2-1)^2", {-1.0, 1.0}, 2e-15},
                                         Touching{"x^3", {0.0}, 1e-20}, Touching{"abs(x-0.5)", {0.5}, 1e-15},
                                         Touching{"x^4-2*x^2+1", {-1.0, 1.0}, 3e-7}));

// f is 0 all the way through two boxes that touch, along the seam: its ends are faces.
TEST(RootWalk, AStretchOfRootsHasTwoFaces) {
  const ImplicitFormula boxes =
      formula("min(max(abs(x), abs(y-0.5), abs(z))-0.5, max(abs(x), abs(y+0.5), abs(z))-0.5)");
  const std::vector<Root> found = all_roots(boxes, {{{0.1, 0, 0, 0}, {1, 0, 0, 0}}, -2.0, 2.0});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(found[0].t, -0.6, 1e-15);
  EXPECT_NEAR(found[1].t, 0.4, 1e-15);
  for (const Root& root : found) EXPECT_EQ(root.kind, RootKind::crossing);
  EXPECT_EQ(found[0].sign_before, 1);
  EXPECT_EQ(found[1].sign_after, 1);
}

// Numbers that underflow say nothing of f.
TEST(RootWalk, NothingIsInventedWhereDoublesUnderflow) {
  const ImplicitFormula f = formula("exp(1000*x) - exp(1000*y)");
  EXPECT_TRUE(all_roots(f, {{{-1, -1.5, 0, 0}, {1, 0, 0, 0}}, -1.0, 0.9}).empty());
}

// A search ends soon where f is nowhere defined, or rounding hides whether it is.
TEST(RootWalk, WorkIsBoundedWhereFIsUndefined) {
  for (const char* text :
       {"x^x - 0.8", "asin(x/abs(x)) - y", "sqrt(x - x) + y", "y - tan(2*x)", "y - floor(x)",
        "exp(1000*(x+3)) - exp(1000*(y+3))", "log(-1 - x^2)", "x^y - 0.5", "y - mod(x, 0.5)"}) {
    const ImplicitFormula f = formula(text);
    RootWalk walk(f, {{{0.013, 0.27, 0.1, 0}, {0.8, 0.6, 0, 0}}, -2.0, 2.0});
    for (Root root; walk.next(root);) {
    }
    EXPECT_LE(walk.work().cells + walk.work().points, 2000U) << text;
  }
  const ImplicitFormula endless = formula("sin(1/x)*sin(1/y)");
  RootWalk walk(endless, {{{1e-3, -1e-3, 0, 0}, {0.6, 0.8, 0, 0}}, -2.0, 2.0});
  for (Root root; walk.next(root);) {
  }
  EXPECT_LE(walk.work().cells, 40000U);
}

TEST(RootWalk, SignsTellTouchingFromCrossing) {
  EXPECT_EQ(along_x("(x-0.3)^2")[0].sign_before, 1);
  EXPECT_EQ(along_x("(x-0.3)^2")[0].sign_after, 1);
  EXPECT_EQ(along_x("(x-0.3)^3")[0].sign_before, -1);
  EXPECT_EQ(along_x("(x-0.3)^3")[0].sign_after, 1);
}

TEST(RootWalk, RootsAtTheEndsBelongToTheInterval) {
  EXPECT_EQ(along_x("x^2 - 1", -1.0, 1.0).size(), 2U);
  EXPECT_EQ(along_x("x^2 - 1", -1.0, std::nextafter(1.0, 0.0)).size(), 1U);
  EXPECT_TRUE(along_x("x^2 - 1", 1.5, -1.5).empty());
}

// Near an expanded triple root rounding hides f here and there; what cannot be told is flagged, and nothing
// else is reported.
TEST(RootWalk, ExpandedTripleRootIsFlaggedWhereItIs) {
  const std::vector<Root> found = along_x("x^3-3*x^2+3*x-1");
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(found.front().lower, 1.0, 1e-4);
  EXPECT_NEAR(found.back().upper, 1.0, 1e-4);
  for (const Root& root : found) EXPECT_EQ(root.kind, RootKind::unresolved);
  EXPECT_TRUE(std::any_of(found.begin(), found.end(),
                          [](const Root& root) { return root.lower <= 1.0 && root.upper >= 1.0; }));
}

TEST(RootWalk, InfinitelyManyRootsEndInOneUnresolved) {
  const std::vector<Root> found = all_roots(formula("sin(1/x)"), {{{2, 0, 0, 0}, {-1, 0, 0, 0}}, 0.0, 2.0});
  ASSERT_GT(found.size(), 100U);
  for (std::size_t i = 0; i < 100; ++i)
    EXPECT_NEAR(2.0 - found[i].t, 1.0 / (pi * static_cast<double>(i + 1)), 1e-15);
  EXPECT_EQ(found.back().kind, RootKind::unresolved);
}

TEST(Implicit, IsAShapeAmongTheOthers) {
  const auto sphere_formula = std::make_shared<const ImplicitFormula>(formula("x^2 + y^2 + z^2 - 1"));
  SurfaceSet set;
  set.add(implicit(sphere_formula, Vec3(-1.5), Vec3(1.5)), Placement(Vec3(1.0, 2.0, 3.0)));
  set.build();
  const Vec3 eye{1.0, 2.5, -1e6};
  const Hit hit = set.nearest(eye, Vec3(0.0, 0.0, 1.0));
  ASSERT_TRUE(hit.found());
  const SurfacePoint point = set.resolve(hit, eye, Vec3(0.0, 0.0, 1.0));
  EXPECT_LE(glm::length(point.position - Vec3(1.0, 2.5, 3.0 - std::sqrt(0.75))), 2e-15);
  EXPECT_LE(glm::length(point.normal - Vec3(0.0, 0.5, -std::sqrt(0.75))), 2e-15);
  EXPECT_LE(point.error_bound, 1e-13);
  EXPECT_FALSE(set.blocked(point.position + point.error_bound * point.normal, point.normal, 100.0));
  EXPECT_TRUE(set.blocked(point.position + point.error_bound * point.normal, -point.normal, 100.0));
}

TEST(Implicit, FollowsItsOwnTime) {
  const auto pulsating = std::make_shared<const ImplicitFormula>(formula("x^2 + y^2 + z^2 - (1 + t/10)^2"));
  SurfaceSet set;
  set.add(implicit(pulsating, Vec3(-3.0), Vec3(3.0)), Placement());
  set.build();
  // Backwards in time at the speed of light from z = -5 at t = 5: at z = -r it is t = 5 - (5 - r) = r = 1 +
  // r/10.
  const Hit hit = set.nearest(Vec3(0.0, 0.0, -5.0), Vec3(0.0, 0.0, 1.0),
                              std::numeric_limits<double>::infinity(), {5.0, -1.0});
  ASSERT_TRUE(hit.found());
  EXPECT_NEAR(hit.lambda, 5.0 - 1.0 / 0.9, 2e-15);
}

}  // namespace
}  // namespace backlight
