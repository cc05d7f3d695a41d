// Paths of waves, and where light meets what goes along them.
#include "backlight/surface/wave_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "backlight/surface/implicit_surface.h"
#include "backlight/surface/matter_motion.h"
#include "backlight/surface/surface_set.h"
#include "formula_text.h"

namespace backlight {
namespace {

using test::formula;

std::array<Expression, 3> three(const std::string& x, const std::string& y, const std::string& z) {
  return {formula(x), formula(y), formula(z)};
}

TEST(WavePath, GoesAlongACircleAtItsSpeed) {
  const auto path = WavePath::of(three("1 + 2*cos(0.9*t)", "3", "2*sin(0.9*t) - 4"), 0.5);
  ASSERT_TRUE(path.has_value());
  EXPECT_NEAR(path->most_speed(), 0.9, 1e-12);
  EXPECT_NEAR(path->most_acceleration(), 0.405, 1e-12);
  const WavePath::Motion there = path->at(7.0);
  EXPECT_NEAR(there.place.x, 1.0 + 2.0 * std::cos(0.45 * 7.0), 1e-13);
  EXPECT_NEAR(there.place.z, 2.0 * std::sin(0.45 * 7.0) - 4.0, 1e-13);
  EXPECT_NEAR(glm::length(there.velocity), 0.9, 1e-13);
}

TEST(WavePath, BoundsWhatItDoes) {
  const auto path =
      WavePath::of(three("0.1*t + 0.3*cos(t)", "0.2*sin(t + 1) - 0.1*cos(2*t)", "0.05*sin(3*t) - t/5"), 1.0);
  ASSERT_TRUE(path.has_value());
  double fastest = 0.0, hardest = 0.0;
  constexpr double step = 1e-3;
  for (int i = -20'000; i < 20'000; ++i) {
    const Vec3 now = path->at(step * i).velocity, then = path->at(step * (i + 1)).velocity;
    fastest = std::max(fastest, glm::length(now));
    hardest = std::max(hardest, glm::length(then - now) / step);
  }
  EXPECT_LE(fastest, path->most_speed());
  EXPECT_LE(hardest, path->most_acceleration());
  EXPECT_GT(fastest, 0.5 * path->most_speed());
  EXPECT_GT(hardest, 0.5 * path->most_acceleration());
}

TEST(WavePath, IsStraightWithoutWaves) {
  const auto path = WavePath::of(three("1 - t/2", "2", "0.25*(t + 4)"), 1.0);
  ASSERT_TRUE(path.has_value());
  EXPECT_TRUE(path->is_straight());
  EXPECT_EQ(path->start(), Vec3(1.0, 2.0, 1.0));
  EXPECT_EQ(path->velocity(), Vec3(-0.5, 0.0, 0.25));
  EXPECT_FALSE(WavePath::of(three("t", "x", "0"), 1.0).has_value());
}

constexpr double radius = 0.2;

/// A ball on a path.
SurfaceSet travelling(const std::array<std::string, 3>& path, double speed) {
  MatterMotion::Body body{three("x + " + path[0], "y + " + path[1], "z + " + path[2]),
                          three("x - (" + path[0] + ")", "y - (" + path[1] + ")", "z - (" + path[2] + ")")};
  const MatterMotion::Ball ball{three(path[0], path[1], path[2]), radius, speed};
  ImplicitOptions options;
  options.motion = std::make_shared<const MatterMotion>(body, sphere(radius), ball, MatterMotion::Time{});
  options.finder = RootFinder::affine;
  const std::string square =
      "(x - (" + path[0] + "))^2 + (y - (" + path[1] + "))^2 + (z - (" + path[2] + "))^2";
  const auto f = std::make_shared<const ImplicitFormula>(formula(square + " - 0.04"));
  SurfaceSet set;
  const Vec3 far{std::numeric_limits<double>::infinity()};
  set.add(implicit(f, -far, far, options), Placement(Vec3{0.0}, Vec3{0.0}, Vec3{1.0}));
  set.build();
  return set;
}

struct Travel {
  const char* name;
  std::array<std::string, 3> path;
  double speed;
};

PassingBall passing_lit_from(const SurfaceSet& set, const LightFlash& flash) {
  const SurfaceSet* sets[] = {&set};
  BoundingSphere sphere;
  PassingBall ball;
  SurfaceSet::lit_from(sets, {&flash, 1}, {&sphere, 1}, {&ball, 1});
  return ball;
}

Vec3 centre_at(const PassingBall& ball, double time) {
  Vec3 centre{0.0};
  for (int k = 0; k < 3; ++k) centre[k] = ball.centre[k] + (time - ball.time) * ball.velocity[k];
  return centre;
}

class LightOnPaths : public testing::TestWithParam<Travel> {};

// Every place of the ball that light of an event passes is in the sphere.
TEST_P(LightOnPaths, StaysInTheSpheres) {
  const Travel& travel = GetParam();
  const SurfaceSet set = travelling(travel.path, travel.speed);
  EXPECT_TRUE(set.any_travels());
  const auto path = three(travel.path[0], travel.path[1], travel.path[2]);
  std::mt19937_64 engine(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(engine() >> 11) * 0x1p-53);
  };
  int met = 0;
  for (int event = 0; event < 40; ++event) {
    const Vec3 place{between(-4.0, 4.0), between(-4.0, 4.0), between(-4.0, 4.0)};
    const double time = between(-20.0, 20.0);
    const double apart = event % 2 == 0 ? 0.0 : between(0.0, 0.5);
    const BoundingSphere lit = set.lit_from({place, time, apart});
    const BoundingSphere seen = set.seen_from(place, time);
    const PassingBall lit_ball = passing_lit_from(set, {place, time, apart});
    const PassingBall seen_ball = set.passing_seen_from(place, time);
    for (int i = 0; i < 4000; ++i) {
      const double ago = between(0.0, 40.0);
      const bool forwards = i % 2 == 0;
      const double at = forwards ? time + ago : time - ago;
      const std::array<double, 4> moment{0.0, 0.0, 0.0, at};
      const Vec3 centre{path[0].evaluate(moment), path[1].evaluate(moment), path[2].evaluate(moment)};
      const double strays = forwards ? apart : 0.0;
      const double length = glm::length(centre - place);
      if (std::abs(length - ago) > radius + strays) continue;
      ++met;
      // Where on the way to the centre, or behind it, that light is in the ball.
      const Vec3 way = (centre - place) / length;
      const Vec3 there = centre - std::clamp(length - ago, -radius, radius) * way;
      const BoundingSphere& sphere = forwards ? lit : seen;
      EXPECT_LE(glm::length(there - sphere.centre), sphere.radius) << at - time;
      const PassingBall& ball = forwards ? lit_ball : seen_ball;
      EXPECT_LE(glm::length(there - centre_at(ball, at)), ball.radius * (1.0 + 1e-12)) << at - time;
    }
    EXPECT_LE(seen.radius, 2.5 * radius / (1.0 - travel.speed));
  }
  EXPECT_GT(met, 500);
}

TEST_P(LightOnPaths, OfAFlashThatIsSeenBeforeMeetNothing) {
  const SurfaceSet set = travelling(GetParam().path, GetParam().speed);
  EXPECT_LT(set.lit_from({{30.0, 0.0, 0.0}, 0.0, 0.0, 1.0}).radius, 0.0);
}

// Paths of different numbers of waves side by side, some without, and what stands still.
TEST(LightOnManyPaths, MeetsTheSpheresOfEach) {
  std::vector<SurfaceSet> sets;
  sets.push_back(travelling({"cos(0.8*t)", "0", "sin(0.8*t)"}, 0.8));
  sets.push_back(travelling({"0.5*cos(t) + 0.1*t", "0.3*sin(t)", "0.4 - 0.2*sin(2*t)"}, 0.95));
  sets.push_back(travelling({"sqrt(1 + t^2)*0.9", "0.2", "0.1*atan(t)"}, 0.99));
  sets.push_back(travelling({"0.9*t", "1", "0.1*t"}, 0.91));
  sets.push_back(
      travelling({"0.1*(cos(t) + cos(2*t) + cos(3*t))", "0.1*(sin(4*t) + sin(0.5*t))", "0"}, 0.99));
  sets.emplace_back();
  sets.back().add(sphere(0.3), Placement(Vec3{1.0, 2.0, 3.0}, Vec3{0.0}, Vec3{1.0}));
  sets.back().build();
  std::mt19937_64 engine(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(engine() >> 11) * 0x1p-53);
  };
  std::vector<const SurfaceSet*> asked;
  std::vector<LightFlash> flashes;
  for (std::size_t i = 0; i < SurfaceSet::most_lit; ++i) {
    asked.push_back(&sets[engine() % sets.size()]);
    const Vec3 place{between(-4.0, 4.0), between(-4.0, 4.0), between(-4.0, 4.0)};
    const double time = between(-20.0, 20.0);
    flashes.push_back({place, time, between(0.0, 0.5), time + between(0.0, 12.0)});
  }
  std::vector<BoundingSphere> spheres(asked.size());
  std::vector<PassingBall> balls(asked.size());
  SurfaceSet::lit_from(asked, flashes, spheres, balls);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const BoundingSphere alone = asked[i]->lit_from(flashes[i]);
    EXPECT_EQ(spheres[i].radius, alone.radius) << i;
    EXPECT_EQ(spheres[i].centre, alone.centre) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Paths, LightOnPaths,
    testing::Values(Travel{"circle", {"cos(0.8*t)", "0", "sin(0.8*t)"}, 0.8},
                    Travel{"oblique", {"0.5*cos(t) + 0.1*t", "0.3*sin(t)", "0.4 - 0.2*sin(2*t)"}, 0.95},
                    Travel{"straight", {"0.9*t", "1", "0.1*t"}, 0.91},
                    Travel{"no_waves", {"sqrt(1 + t^2)*0.9", "0.2", "0.1*atan(t)"}, 0.99}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace backlight
