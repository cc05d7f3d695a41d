// What clocks of matter in motion count: docs/physics.md equation (25).
#include <gtest/gtest.h>

#include <cmath>

#include "backlight/surface/matter_motion.h"
#include "formula_text.h"

namespace backlight {
namespace {

using test::formula;

/// A wheel that turns at 0.9 and rolls along at `way`, in lengths of 2 for a second.
MatterMotion wheel(const std::string& way, std::optional<double> period) {
  MatterMotion::Body body{{formula("x*cos(0.9*t) - y*sin(0.9*t) + " + way + "*t"),
                           formula("x*sin(0.9*t) + y*cos(0.9*t)"), formula("z")},
                          {formula("(x - " + way + "*t)*cos(0.9*t) + y*sin(0.9*t)"),
                           formula("y*cos(0.9*t) - (x - " + way + "*t)*sin(0.9*t)"), formula("z")},
                          period};
  return {body, sphere(1.0), std::nullopt, {.seconds_per_length = 0.5}};
}

constexpr double turn = 6.283185307179586 / 0.9;

double own_time(const MatterMotion& motion, const Vec3& place, double time) {
  return motion.own_time(place, time, Mat3(1.0));
}

TEST(OwnTime, OfWhatTurnsSteadilyIsUniformForEver) {
  const MatterMotion motion = wheel("0", turn);
  for (const double time : {-1e9, -12345.6, -3.0, 0.0, 0.7, 20.0, 1e5}) {
    for (const double radius : {0.1, 1.0, 2.0}) {
      const double exact = time * std::sqrt(1.0 - 0.45 * 0.45 * radius * radius);
      EXPECT_NEAR(own_time(motion, {0.0, radius, 0.3}, time), exact, 1e-13 * std::abs(exact));
    }
  }
}

// Told that each point's speed stays, it asks once.
TEST(OwnTime, OfWhatIsSteadyIsThatOfTheQuadrature) {
  MatterMotion::Body body{
      {formula("x*cos(0.9*t) - y*sin(0.9*t)"), formula("x*sin(0.9*t) + y*cos(0.9*t)"), formula("z")},
      {formula("x*cos(0.9*t) + y*sin(0.9*t)"), formula("y*cos(0.9*t) - x*sin(0.9*t)"), formula("z")}};
  const MatterMotion by_quadrature(body, sphere(1.0), std::nullopt, {.seconds_per_length = 0.5});
  body.steady = true;
  const MatterMotion at_once(body, sphere(1.0), std::nullopt, {.seconds_per_length = 0.5});
  const Mat3 larger(1.3);
  for (const double time : {-7.0, 0.0, 0.7, 20.0}) {
    const Vec3 place{0.3, -0.8, 0.2};
    const double exact = by_quadrature.own_time(place, time, larger);
    EXPECT_NEAR(at_once.own_time(place, time, larger), exact, 1e-13 * std::abs(exact)) << time;
  }
}

// A rim point of a wheel that rolls at 0.9: v is between 0.0 and 0.9.
TEST(OwnTime, IsTheSameByPeriodsAsWithout) {
  const MatterMotion by_periods = wheel("0.9", turn), without = wheel("0.9", {});
  for (const double time : {-300.0, -31.4, -13.9, -2.0, 5.0, 14.0, 77.7}) {
    const Vec3 place{0.45 * time + 0.3, -0.8, 0.0};
    const double exact = own_time(without, place, time);
    EXPECT_NEAR(own_time(by_periods, place, time), exact, 2e-12 * std::abs(exact)) << time;
  }
}

TEST(OwnTime, GoesOnByTheSameEachPeriod) {
  const MatterMotion motion = wheel("0.9", turn);
  const double period = 2.0 * turn;  // in lengths
  const auto at = [&](double periods) {
    const double time = (periods + 0.3) * period;
    // Where one body point is.
    const Vec3 place{0.45 * time + 0.5 * std::cos(0.45 * time), 0.5 * std::sin(0.45 * time), 0.0};
    return own_time(motion, place, time);
  };
  const double once = at(1.0) - at(0.0);
  EXPECT_GT(once, 0.5 * period);
  EXPECT_NEAR(at(10'000.0) - at(0.0), 10'000.0 * once, 1e-9 * 10'000.0);
}

}  // namespace
}  // namespace backlight
