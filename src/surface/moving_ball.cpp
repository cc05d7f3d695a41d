#include "moving_ball.h"

#include <algorithm>
#include <cmath>

namespace backlight {
namespace {

/// Where the line passes the centre.
struct Meeting {
  double s;
  Vec3 centre;
  double ahead;  ///< of the line's point at s
};

/// (c(t(s)) - x(s))·d falls with s, since |dt/ds| <= 1 and the centre is slower than light: Newton's method
/// within a bracket, until it is off by no more than `enough`. Any s will do for the bounds; this one makes
/// them narrow.
Meeting meeting(const MatterMotion& motion, const LocalLine& line, double enough) {
  const MatterMotion::Ball& ball = *motion.ball();
  double low = -infinite;
  double high = infinite;
  double s = 0.0;
  constexpr int most_steps = 60;
  for (int i = 0;; ++i) {
    const double time = std::max(line.clock.start + s * line.clock.rate, ball.begins);
    const MatterMotion::Centre centre = motion.centre(time);
    const double ahead = glm::dot(centre.place - line.at(s), line.direction);
    if (std::abs(ahead) <= enough || i == most_steps || !std::isfinite(ahead))
      return {s, centre.place, ahead};
    (ahead < 0.0 ? high : low) = s;
    const double farthest = s + ahead / (1.0 - ball.speed);
    ahead < 0.0 ? low = std::max(low, farthest) : high = std::min(high, farthest);
    const double next = s + ahead / (1.0 - line.clock.rate * glm::dot(centre.velocity, line.direction));
    s = next > low && next < high ? next : 0.5 * low + 0.5 * high;
  }
}

}  // namespace

Stretch inside_ball(const MatterMotion& motion, const LocalLine& line) {
  const MatterMotion::Ball& ball = *motion.ball();
  const Meeting at = meeting(motion, line, 0.05 * ball.radius);
  // From where the line is nearest to that place of the centre, u away: |x - c| <= r + v |dt|, and so
  // b² + u² <= (r + βu)².
  const double nearest = at.s + at.ahead;
  const double beta = ball.speed * std::abs(line.clock.rate);
  const Vec3 aside = line.at(nearest) - at.centre;
  const double room = 1e-12 * (ball.radius + std::abs(nearest) + glm::length(at.centre));
  const double radius = ball.radius + beta * std::abs(at.ahead) + room;
  const double rest = 1.0 - beta * beta;
  const double under = radius * radius - rest * glm::dot(aside, aside);
  Stretch stretch;
  if (!(under >= 0.0)) {
    stretch.close();
    return stretch;
  }
  const double reach = (radius * beta + std::sqrt(under)) / rest;
  stretch.in = nearest - reach;
  stretch.out = nearest + reach;
  const double begin = (ball.begins - line.clock.start) / line.clock.rate;
  if (line.clock.rate < 0.0) stretch.out = std::min(stretch.out, begin);
  if (line.clock.rate > 0.0) stretch.in = std::max(stretch.in, begin);
  return stretch;
}

}  // namespace backlight
