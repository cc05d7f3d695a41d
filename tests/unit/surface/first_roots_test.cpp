// The first roots of many lines at once: those that each line has by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <variant>

#include "../../../src/surface/implicit_roots.h"

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

class FirstRoots : public testing::TestWithParam<const char*> {};

TEST_P(FirstRoots, AreTheSameAloneInABatchAndOnTheWalk) {
  const auto pieces = lines(300);
  const ImplicitFormula f = formula(GetParam());
  std::vector<Root> together(pieces.size());
  first_roots(f, pieces, together);
  int hits = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Root alone = first_root(f, pieces[i], pieces[i].from, pieces[i].to);
    ASSERT_EQ(found(alone), found(together[i]));
    RootWalk walk(f, pieces[i], pieces[i].from, pieces[i].to);
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
    testing::Values("4*(2.618*x^2-y^2)*(2.618*y^2-z^2)*(2.618*z^2-x^2)-4.236*(x^2+y^2+z^2-1)^2",
                    "sin(4*x)*cos(4*y)+sin(4*y)*cos(4*z)+sin(4*z)*cos(4*x)", "y-0.3/x+0.2*z^2",
                    "(x^2+y^2+z^2-1)^2", "sqrt(x^2+y^2) - 1 + 0.2*t + 0.1*tan(z)", "floor(2*x) + y",
                    "max(abs(x), abs(y), abs(z)) - 1", "x^2 + y^2 + z^2 - 1 - 0.5*sin(9*t)"));

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
    for (const double y : {1.0 - off, 1.0 + off}) {
      const Root root = first_root(f, {{0, y, 0, 0}, {1, 0, 0, 0}}, -2.0, 2.0);
      ASSERT_EQ(found(root), y < 1.0) << y - 1.0;
      if (y > 1.0) continue;
      EXPECT_EQ(root.kind, RootKind::crossing);
      EXPECT_NEAR(root.t, -std::sqrt((1.0 - y) * (1.0 + y)), 1e-15 / std::sqrt(off));
    }
  }
}

}  // namespace
}  // namespace backlight
