// Balls on paths of waves: their own search against the one of their formula, and one ray against many.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "backlight/surface/implicit_surface.h"
#include "backlight/surface/matter_motion.h"
#include "backlight/surface/surface_set.h"
#include "formula_text.h"
#include "random_numbers.h"

namespace backlight {
namespace {

using test::formula;
using test::Numbers;

constexpr double radius = 0.3;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Travel {
  const char* name;
  std::array<std::string, 3> path;
  double speed;
  double begins;
};

std::array<Expression, 3> three(const std::string& x, const std::string& y, const std::string& z) {
  return {formula(x), formula(y), formula(z)};
}

std::shared_ptr<const MatterMotion> motion_of(const Travel& travel) {
  const auto& [x, y, z] = travel.path;
  MatterMotion::Body body{three("x + " + x, "y + " + y, "z + " + z),
                          three("x - (" + x + ")", "y - (" + y + ")", "z - (" + z + ")")};
  const MatterMotion::Ball ball{three(x, y, z), radius, travel.speed, travel.begins};
  return std::make_shared<const MatterMotion>(body, sphere(radius), ball, MatterMotion::Time{1.0, false});
}

SurfaceSet set_of(const Shape& shape) {
  SurfaceSet set;
  set.add(shape, Placement(Vec3{0.1, -0.2, 0.3}, Vec3{0.0}, Vec3{1.0}));
  set.build();
  return set;
}

SurfaceSet by_formula(const Travel& travel) {
  ImplicitOptions options;
  options.motion = motion_of(travel);
  options.finder = RootFinder::affine;
  const auto& [x, y, z] = travel.path;
  const auto f = std::make_shared<const ImplicitFormula>(
      formula("(x - (" + x + "))^2 + (y - (" + y + "))^2 + (z - (" + z + "))^2 - 0.09"));
  return set_of(implicit(f, Vec3{-infinity}, Vec3{infinity}, options));
}

struct Line {
  Vec3 origin, direction;
  RayClock clock;
};

/// Through the ball, or near it, or from within it; light, and what is slower, forwards and backwards.
Line line_near(const MatterMotion& motion, Numbers& numbers) {
  static constexpr std::array<double, 6> rates{-1.0, -1.0, -1.0, -0.4, 0.0, 0.7};
  const double rate = rates[static_cast<std::size_t>(numbers.between(0.0, 6.0))];
  const double length = numbers.between(0.5, 2.0), ago = numbers.between(-0.2, 5.0);
  const double then = numbers.between(-9.0, 3.0);
  const Vec3 direction = numbers.direction();
  const Vec3 target = Vec3{0.1, -0.2, 0.3} + motion.centre(then).place +
                      numbers.between(0.0, 1.3 * radius) * numbers.direction();
  return {target - ago * direction, length * direction, {then - ago * rate, length * rate}};
}

class TravellingBalls : public testing::TestWithParam<Travel> {};

TEST_P(TravellingBalls, AreFoundWhereTheirFormulaIs) {
  const auto motion = motion_of(GetParam());
  const SurfaceSet ball = set_of(travelling_ball(radius, false, motion)), other = by_formula(GetParam());
  Numbers numbers(11);
  int hits = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Line line = line_near(*motion, numbers);
    const Hit a = ball.nearest(line.origin, line.direction, infinity, line.clock);
    const Hit b = other.nearest(line.origin, line.direction, infinity, line.clock);
    EXPECT_EQ(a.found(), b.found()) << i;
    EXPECT_EQ(ball.blocked(line.origin, line.direction, 3.0, line.clock),
              other.blocked(line.origin, line.direction, 3.0, line.clock))
        << i;
    if (!a.found() || !b.found()) continue;
    ++hits;
    const SurfacePoint p = ball.resolve(a, line.origin, line.direction, line.clock);
    const SurfacePoint q = other.resolve(b, line.origin, line.direction, line.clock);
    const double time = line.clock.start + a.lambda * line.clock.rate;
    const Vec3 out = p.position - Vec3{0.1, -0.2, 0.3} - motion->centre(time).place;
    // Where the line only grazes, rounding moves the crossing more.
    const Vec3 way = line.direction - line.clock.rate * motion->centre(time).velocity;
    const double steep = std::abs(glm::dot(out, way)) / (radius * glm::length(line.direction));
    EXPECT_NEAR(a.lambda, b.lambda, 1e-13 + 1e-13 / steep) << i;
    EXPECT_NEAR(glm::length(out), radius, 1e-13);
    EXPECT_LT(glm::length(p.normal - q.normal), 1e-11 + 1e-12 / steep);
    EXPECT_LT(glm::length(p.velocity - q.velocity), 1e-12 + 1e-12 / steep);
    EXPECT_TRUE(p.moves);
  }
  EXPECT_GT(hits, 5'000);
}

// Up to 64 rays at once, in each width, and one after the other.
TEST_P(TravellingBalls, AreFoundByManyRaysAsByOne) {
  const auto motion = motion_of(GetParam());
  const SurfaceSet set = set_of(travelling_ball(radius, false, motion));
  Numbers numbers(11);
  for (const InstructionSet instructions :
       {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::widest}) {
    RaySheet sheet;
    sheet.padded = sheet_size;
    sheet.instructions = instructions;
    Line lines[sheet_size];
    SheetHits hits;
    hits.clear(sheet_size);
    for (int i = 0; i < sheet_size; ++i) {
      lines[i] = line_near(*motion, numbers);
      for (int k = 0; k < 3; ++k) {
        sheet.origin[k][i] = lines[i].origin[k];
        sheet.direction[k][i] = lines[i].direction[k];
      }
      sheet.length[i] = glm::length(lines[i].direction);
      sheet.start_time[i] = lines[i].clock.start;
      sheet.time_rate[i] = lines[i].clock.rate;
    }
    set.nearest(sheet, ~std::uint64_t{0}, 0.0, hits);
    for (int i = 0; i < sheet_size; ++i) {
      const Hit one = set.nearest(lines[i].origin, lines[i].direction, infinity, lines[i].clock);
      EXPECT_EQ(hits.lambda[i], one.lambda) << i;
      if (one.found()) {
        EXPECT_EQ(hits.along[i], one.along) << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Paths, TravellingBalls,
    testing::Values(
        Travel{"circle", {"cos(0.8*t)", "0", "sin(0.8*t)"}, 0.8, -infinity},
        Travel{"fast", {"0.5*cos(1.9*t)", "0.5*sin(1.9*t)", "0.1"}, 0.95, -infinity},
        Travel{"oblique", {"0.5*cos(t) + 0.1*t", "0.3*sin(t)", "0.4 - 0.2*sin(2*t)"}, 0.95, -infinity},
        Travel{"straight", {"0.9*t", "1", "0.1*t"}, 0.91, -infinity},
        Travel{"begun", {"sin(0.7*t)", "0.2*t", "0"}, 0.75, -4.0}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace backlight
