// The first roots of many lines at once: those that each line has by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <tuple>
#include <variant>

#include "../../../src/surface/root_choice.h"
#include "backlight/surface/implicit_surface.h"

namespace backlight {
namespace {

ImplicitFormula formula(const std::string& text) {
  auto parsed = Expression::parse(text, {"x", "y", "z", "t"});
  if (const auto* wrong = std::get_if<ExpressionError>(&parsed)) {
    ADD_FAILURE() << text << ": " << wrong->message;
    return ImplicitFormula(Expression{});
  }
  return ImplicitFormula(std::get<Expression>(std::move(parsed)));
}

Root first_root(const ImplicitFormula& f, const LinePiece& piece, RootFinder finder) {
  Root root;
  first_roots(f, {&piece, 1}, {&root, 1}, finder);
  return root;
}

/// Lines across a ball of radius 2, with a clock.
std::vector<LinePiece> lines(int count) {
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  std::vector<LinePiece> pieces;
  while (static_cast<int>(pieces.size()) < count) {
    Vec3 d{normal(generator), normal(generator), normal(generator)};
    d /= glm::length(d);
    Vec3 o{normal(generator), normal(generator), normal(generator)};
    o -= glm::dot(o, d) * d;
    if (glm::length(o) > 2.0) continue;
    const double half = std::sqrt(4.0 - glm::dot(o, o));
    pieces.push_back({{{o.x, o.y, o.z, 0.1}, {d.x, d.y, d.z, 0.3}}, -half, half});
  }
  return pieces;
}

using Case = std::tuple<const char*, RootFinder>;
class FirstRoots : public testing::TestWithParam<Case> {};

TEST_P(FirstRoots, AreTheSameAloneInABatchAndOnTheWalk) {
  const auto pieces = lines(300);
  const auto [text, finder] = GetParam();
  const ImplicitFormula f = formula(text);
  std::vector<Root> together(pieces.size());
  first_roots(f, pieces, together, finder);
  int hits = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Root alone = first_root(f, pieces[i], finder);
    ASSERT_EQ(found(alone), found(together[i]));
    RootWalk walk(f, pieces[i]);
    Root walked;
    ASSERT_EQ(walk.next(walked), found(alone));
    if (!found(alone)) continue;
    ++hits;
    EXPECT_EQ(alone.t, together[i].t);
    EXPECT_EQ(alone.kind, together[i].kind);
    EXPECT_EQ(alone.kind, walked.kind);
    EXPECT_EQ(alone.sign_before, walked.sign_before);
    EXPECT_EQ(alone.sign_after, walked.sign_after);
    // Two ways of coming down to the last bits of a simple root.
    if (alone.kind == RootKind::crossing) {
      EXPECT_NEAR(alone.t, walked.t, 1e-13);
    }
  }
  EXPECT_GT(hits, 50);
}

INSTANTIATE_TEST_SUITE_P(
    Formulas, FirstRoots,
    testing::Combine(
        testing::Values(
            "4*(2.618*x^2-y^2)*(2.618*y^2-z^2)*(2.618*z^2-x^2)-4.236*(x^2+y^2+z^2-1)^2",
            "sin(4*x)*cos(4*y)+sin(4*y)*cos(4*z)+sin(4*z)*cos(4*x)", "y-0.3/x+0.2*z^2", "(x^2+y^2+z^2-1)^2",
            "sqrt(x^2+y^2) - 1 + 0.2*t + 0.1*tan(z)", "floor(2*x) + y", "max(abs(x), abs(y), abs(z)) - 1",
            "x^2 + y^2 + z^2 - 1 - 0.5*sin(9*t)",
            "128*x^8-256*x^6+160*x^4-32*x^2+128*y^8-256*y^6+160*y^4-32*y^2+128*z^8-256*z^6+160*z^4-32*z^2+4"),
        testing::Values(RootFinder::interval, RootFinder::affine)));

INSTANTIATE_TEST_SUITE_P(
    Polynomials, FirstRoots,
    testing::Combine(
        testing::Values(
            "4*(2.618*x^2-y^2)*(2.618*y^2-z^2)*(2.618*z^2-x^2)-4.236*(x^2+y^2+z^2-1)^2", "(x^2+y^2+z^2-1)^2",
            "(x^2+y^2+z^2+0.96)^2-4*(x^2+z^2)", "x^2 + y^2 + z^2 - 1 - 0.5*t*x", "z - 0.1*t",
            "128*x^8-256*x^6+160*x^4-32*x^2+128*y^8-256*y^6+160*y^4-32*y^2+128*z^8-256*z^6+160*z^4-32*z^2+4",
            "((x^2+y^2-0.5)^2+z^2-0.01)*((y^2+z^2-0.5)^2+x^2-0.01)*((z^2+x^2-0.5)^2+y^2-0.01)-1e-4"),
        testing::Values(RootFinder::polynomial)));

// Whether there is a root at all is the same, whether or not its place is wanted.
TEST_P(FirstRoots, ExistWhereTheyAreFound) {
  const auto pieces = lines(300);
  const auto [text, finder] = GetParam();
  const ImplicitFormula f = formula(text);
  std::vector<Root> places(pieces.size());
  std::vector<Root> existing(pieces.size());
  RootWork work;
  first_roots(f, pieces, places, finder);
  first_roots(f, pieces, existing, finder, &work, RootsWanted::existence);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    ASSERT_EQ(found(places[i]), found(existing[i])) << i;
    if (!found(places[i])) continue;
    EXPECT_GE(existing[i].t, pieces[i].from);
    EXPECT_LE(existing[i].t, pieces[i].to);
  }
  EXPECT_EQ(work.polish, 0U);
}

TEST(FirstRoots, OfNothingAreNone) {
  const ImplicitFormula f = formula("x^2 + y^2 + z^2 - 1");
  first_roots(f, {}, {});
  const LinePiece backwards{{{0, 0, 0, 0}, {1, 0, 0, 0}}, 2.0, -2.0};
  Root root;
  first_roots(f, {&backwards, 1}, {&root, 1});
  EXPECT_FALSE(found(root));
}

TEST(FirstRoots, AreThoseOfTangentLinesToo) {
  const ImplicitFormula f = formula("x^2 + y^2 + z^2 - 1");
  for (int e = 1; e <= 14; ++e) {
    const double off = std::pow(10.0, -e);
    for (const auto& [y, finder] :
         {std::pair{1.0 - off, RootFinder::interval}, std::pair{1.0 + off, RootFinder::interval},
          std::pair{1.0 - off, RootFinder::affine}, std::pair{1.0 + off, RootFinder::affine},
          std::pair{1.0 - off, RootFinder::polynomial}, std::pair{1.0 + off, RootFinder::polynomial}}) {
      const Root root = first_root(f, {{{0, y, 0, 0}, {1, 0, 0, 0}}, -2.0, 2.0}, finder);
      ASSERT_EQ(found(root), y < 1.0) << y - 1.0;
      if (y > 1.0) continue;
      EXPECT_EQ(root.kind, RootKind::crossing);
      EXPECT_NEAR(root.t, -std::sqrt((1.0 - y) * (1.0 + y)), 1e-15 / std::sqrt(off));
    }
  }
}

// A shadow ray leaves from next to the surface: it meets it no more, or again beyond.
TEST(FirstRoots, AreNotTheStartOfALineThatLeaves) {
  const ImplicitFormula f = formula("x^2 + y^2 + z^2 - 1");
  for (const RootFinder finder : {RootFinder::interval, RootFinder::affine, RootFinder::polynomial}) {
    for (const double off : {1e-3, 1e-9, 1e-14}) {
      const FormulaLine line{{0.3, -0.2, 0.1, 0}, {0.6, 0.8, 0, 0}};
      const double middle = -(0.3 * 0.6 - 0.2 * 0.8);
      const double half = std::sqrt(middle * middle - (0.09 + 0.04 + 0.01 - 1.0));
      EXPECT_FALSE(found(first_root(f, {line, middle + half + off, 4.0}, finder))) << off;
      const Root far = first_root(f, {line, middle - half + off, 4.0}, finder);
      ASSERT_TRUE(found(far)) << off;
      EXPECT_NEAR(far.t, middle + half, 1e-14);
    }
  }
}

// The choice is made by counting, so it is known.
TEST(RootChoice, TakesTheSearchOfFewestSteps) {
  const Vec3 corner{1.25};
  for (const char* text :
       {"128*x^8-256*x^6+160*x^4-32*x^2+128*y^8-256*y^6+160*y^4-32*y^2+128*z^8-256*z^6+160*z^4-32*z^2+4",
        "4*(2.618*x^2-y^2)*(2.618*y^2-z^2)*(2.618*z^2-x^2)-4.236*(x^2+y^2+z^2-1)^2"}) {
    EXPECT_EQ(choose_root_finder(formula(text), -corner, corner), RootFinder::polynomial) << text;
  }
  for (const char* text : {"sin(3*x)*cos(3*y)+sin(3*y)*cos(3*z)+sin(3*z)*cos(3*x)", "x^2+y^2+z^14-1"}) {
    EXPECT_EQ(choose_root_finder(formula(text), -corner, corner), RootFinder::affine) << text;
  }
  // Forms cannot be made of roots of what is never negative, but comes near to it.
  for (const char* text : {"sqrt(x^2 + y^2) - 1", "floor(3*x) + y"}) {
    EXPECT_EQ(choose_root_finder(formula(text), -corner, corner), RootFinder::interval) << text;
  }
}

TEST(RootChoice, DoesNotWalkLinesOfVeryManyPieces) {
  const ImplicitFormula f = formula("sin(1/(x*x + 1e-9)) + 0*y");
  for (const RootFinder finder : {RootFinder::interval, RootFinder::affine}) {
    const RootWork work = probe(f, Vec3{-1.0}, Vec3{1.0}, finder);
    EXPECT_EQ(work.walked, 0U);
    EXPECT_LT(work.cells + work.forms, 32U * 500U);
  }
}

TEST(RootChoice, IsWhatTheShapeSays) {
  const auto f = std::make_shared<const ImplicitFormula>(formula("x^2 + y^2 + z^2 - 1"));
  const Vec3 corner{1.25};
  EXPECT_EQ(root_finder(implicit(f, -corner, corner)), choose_root_finder(*f, -corner, corner));
  for (const RootFinder finder : {RootFinder::interval, RootFinder::affine, RootFinder::polynomial}) {
    ImplicitOptions options;
    options.finder = finder;
    EXPECT_EQ(root_finder(implicit(f, -corner, corner, options)), finder);
  }
}

}  // namespace
}  // namespace backlight
