// What is found of bodies in motion in the little of a line where their boxes are is what is found on all of
// it: docs/physics.md equation (28f).
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "backlight/expression/compose.h"
#include "backlight/surface/implicit_surface.h"
#include "backlight/surface/matter_motion.h"
#include "backlight/surface/solid.h"
#include "backlight/surface/surface_set.h"
#include "formula_text.h"
#include "random_numbers.h"

namespace backlight {
namespace {

using test::formula;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A plate that swings along y and turns about z, with 0.71 c at its ends.
struct Motion {
  const char *name, *height, *angle;
};
const std::array<Motion, 3> motions{{{"Turns", "0", "0.7*t"},
                                     {"TurnsAndSwings", "0.1*sin(0.8*t)", "0.7*t"},
                                     {"Rocks", "0.05*t", "2 + 0.5*sin(1.4*t)"}}};

/// f of X, Y and Z as a formula of a place and t.
std::string moved(const std::string& f, const Motion& motion) {
  const std::string up = "(y - " + std::string(motion.height) + ")",
                    c = "cos(" + std::string(motion.angle) + ")",
                    s = "sin(" + std::string(motion.angle) + ")";
  std::string text;
  for (const char letter : f) {
    if (letter == 'X') {
      text += "(x*" + c + " + " + up + "*" + s + ")";
    } else if (letter == 'Y') {
      text += "(" + up + "*" + c + " - x*" + s + ")";
    } else {
      text += letter == 'Z' ? 'z' : letter;
    }
  }
  return text;
}

std::shared_ptr<const LineProgram> common_of(const Motion& motion) {
  Composer composer(4);
  std::array<Composer::Node, 4> at{};
  for (std::size_t v = 0; v < 4; ++v) at[v] = composer.variable(v);
  std::array<Composer::Node, 3> results{};
  const char* const letters[3]{"X", "Y", "Z"};
  for (std::size_t k = 0; k < 3; ++k) results[k] = composer.insert(formula(moved(letters[k], motion)), at);
  return std::make_shared<const LineProgram>(composer.tape(results));
}

/// A bar of the plate, and its box.
struct Bar {
  const char* f;
  BodyBox box;
};
const std::array<Bar, 3> bars{
    {{"max(abs(X) - 0.9, abs(Y) - 0.05, abs(Z) - 0.04)",
      {{}, {0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0.9, 0.05, 0.04}}},
     {"max((0.6*X + 0.8*Y - 0.3)^2 + Z^2 - 0.01, abs(0.8*X - 0.6*Y) - 0.4)",
      {{}, {0.18, 0.24, 0}, {{0.6, 0.8, 0}, {0.8, -0.6, 0}, {0, 0, 1}}, {0.1, 0.4, 0.1}}},
     {"(X - 0.4)^2 + Y^2 + (Z - 0.05)^2 - 0.0144",
      {{}, {0.4, 0, 0.05}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0.12, 0.12, 0.12}}}}};

Shape bar_in_motion(const Motion& motion, const Bar& bar, std::shared_ptr<const LineProgram> common) {
  MatterMotion::Body body;
  const char* const letters[3]{"X", "Y", "Z"};
  for (std::size_t k = 0; k < 3; ++k) body.point[k] = formula(moved(letters[k], motion));
  const std::string c = "cos(" + std::string(motion.angle) + ")",
                    s = "sin(" + std::string(motion.angle) + ")";
  body.place = {formula("x*" + c + " - y*" + s),
                formula(std::string(motion.height) + " + x*" + s + " + y*" + c), formula("z")};
  if (common) {
    body.box = bar.box;
    body.box->common = std::move(common);
  }
  ImplicitOptions options;
  options.motion =
      std::make_shared<const MatterMotion>(body, sphere(1.0), std::nullopt, MatterMotion::Time{});
  options.finder = RootFinder::affine;
  return implicit(std::make_shared<const ImplicitFormula>(formula(moved(bar.f, motion))), {-1, -1.2, -0.2},
                  {1, 1.2, 0.2}, options);
}

SurfaceSet set_of(const Motion& motion, bool with_boxes, SolidOperation operation) {
  const auto common = with_boxes ? common_of(motion) : nullptr;
  SolidTree tree;
  tree.operation = operation;
  for (const Bar& bar : bars) {
    SolidTree part;
    part.shape = bar_in_motion(motion, bar, common);
    tree.parts.push_back(part);
  }
  SurfaceSet set;
  set.add(csg(tree), Placement(Vec3{0.1, -0.2, 0.3}, Vec3{0.0}, Vec3{1.0}));
  set.add(bar_in_motion(motion, bars[1], common), Placement(Vec3{0.1, -0.2, 1.3}, Vec3{0.0}, Vec3{1.0}));
  set.build();
  return set;
}

struct Line {
  Vec3 origin, direction;
  RayClock clock;
};

/// Light and what is slower; along the plate, across it, and from within it.
Line line_through(test::Numbers& numbers) {
  static constexpr std::array<double, 5> rates{-1.0, -1.0, -0.4, 0.0, 0.7};
  const double rate = rates[static_cast<std::size_t>(numbers.between(0.0, 5.0))];
  const Vec3 target{numbers.between(-0.9, 1.1), numbers.between(-1.2, 0.8),
                    0.3 + (numbers.between(0.0, 1.0) < 0.3 ? 1.0 : 0.0) + numbers.between(-0.1, 0.1)};
  const double flat = numbers.between(0.0, 1.0) < 0.3 ? 0.03 : 1.0;
  Vec3 direction = numbers.direction();
  direction = glm::normalize(Vec3{direction.x, direction.y, flat * direction.z});
  const double ago = numbers.between(-0.2, 3.0), length = numbers.between(0.5, 2.0);
  return {target - ago * direction, length * direction, {numbers.between(-9.0, 9.0), length * rate}};
}

class MovingBoxes : public testing::TestWithParam<Motion> {};

TEST_P(MovingBoxes, LeaveNothingOut) {
  for (const SolidOperation operation : {SolidOperation::unite, SolidOperation::difference}) {
    const SurfaceSet near = set_of(GetParam(), true, operation),
                     everywhere = set_of(GetParam(), false, operation);
    test::Numbers numbers(5);
    int hits = 0, blocked = 0;
    for (int i = 0; i < 20'000; ++i) {
      const Line line = line_through(numbers);
      const Hit a = near.nearest(line.origin, line.direction, infinity, line.clock);
      const Hit b = everywhere.nearest(line.origin, line.direction, infinity, line.clock);
      ASSERT_EQ(a.found(), b.found()) << i;
      const bool is_blocked = near.blocked(line.origin, line.direction, 1.5, line.clock);
      EXPECT_EQ(is_blocked, everywhere.blocked(line.origin, line.direction, 1.5, line.clock)) << i;
      blocked += is_blocked ? 1 : 0;
      if (!a.found()) continue;
      ++hits;
      EXPECT_EQ(a.surface, b.surface) << i;
      const SurfacePoint p = near.resolve(a, line.origin, line.direction, line.clock);
      const Vec3 way = line.direction / glm::length(line.direction);
      const double steep =
          std::abs(glm::dot(p.normal, way - line.clock.rate / glm::length(line.direction) * p.velocity));
      EXPECT_NEAR(a.lambda, b.lambda, 1e-13 + 1e-14 / steep) << i;
    }
    EXPECT_GT(hits, 2'000);
    EXPECT_GT(blocked, 1'000);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, MovingBoxes, testing::ValuesIn(motions),
                         [](const auto& its) { return std::string(its.param.name); });

}  // namespace
}  // namespace backlight
