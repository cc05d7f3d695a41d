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

namespace {

/// The ball about a moment: no farther than `radius` from centre + velocity (t - time), while that is within
/// half_time.
struct Passing {
  double time;
  double half_time;
  Vec3 centre;
  Vec3 velocity;
  double radius;
};

Passing passing_at(const MatterMotion& motion, double time, double half_time) {
  const MatterMotion::Ball& ball = *motion.ball();
  const MatterMotion::Centre centre = motion.centre(time);
  const double strays = motion.change_of_velocity(centre.velocity, time - half_time, time + half_time);
  return {time, half_time, centre.place, centre.velocity, ball.radius + half_time * strays};
}

/// When light left the centre that arrives at an event: the root of (29), or the moment from which on the
/// motion is known.
double retarded_time(const MatterMotion& motion, const Vec3& place, double time, double enough) {
  const MatterMotion::Ball& ball = *motion.ball();
  double low = -infinite;
  double high = time;
  double at = std::max(time, ball.begins);
  constexpr int most_steps = 60;
  for (int i = 0; i < most_steps; ++i) {
    const MatterMotion::Centre centre = motion.centre(at);
    const Vec3 way = centre.place - place;
    const double length = glm::length(way);
    const double late = (time - at) - length;
    if (!(std::abs(late) > enough)) break;
    (late > 0.0 ? low : high) = at;
    const double next = at + late / (1.0 + (length > 0.0 ? glm::dot(way, centre.velocity) / length : 0.0));
    const double within = next > low && next < high ? next
                          : std::isfinite(low)      ? 0.5 * low + 0.5 * high
                                                    : at - 2.0 * std::abs(late) / (1.0 - ball.speed);
    if (within < ball.begins) return ball.begins;
    at = within;
  }
  return at;
}

/// The passing that is seen from an event, and from others no farther than `apart` from it. Of light that
/// left within r of the centre at t, |h(t)| <= r + apart with the h of (29), which falls: between its roots
/// for times that much earlier and later.
Passing passing_of_light(const MatterMotion& motion, const Vec3& place, double time, double apart) {
  const MatterMotion::Ball& ball = *motion.ball();
  const double doubt = 1e-3 * ball.radius;
  const double reach = ball.radius + apart + 2.0 * doubt + 1e-12 * std::abs(time);
  const double first = retarded_time(motion, place, time - reach, doubt);
  const double last = retarded_time(motion, place, time + reach, doubt);
  return passing_at(motion, 0.5 * first + 0.5 * last,
                    0.5 * (last - first) * (1.0 + 1e-9) + 1e-12 * std::abs(time));
}

struct LineStart {
  Vec3 place;
  double time;
};
LineStart start_of(const LocalLines& lines, std::size_t i) {
  const double s = lines.at_lambda(i, 0.0);
  const LocalLine line = lines.line(i);
  return {line.at(s), line.clock.start + s * line.clock.rate};
}

bool is_light(const LocalLine& line) {
  return std::abs(line.clock.rate + 1.0) < 1e-9;
}

Stretch inside_passing(const Passing& ball, const LocalLine& line, double begins) {
  Stretch stretch;
  const Vec3 from = line.point - ball.centre - (line.clock.start - ball.time) * ball.velocity;
  const Vec3 way = line.direction - line.clock.rate * ball.velocity;
  const double square = glm::dot(way, way);
  const double nearest = -glm::dot(from, way) / square;
  const Vec3 aside = from + nearest * way;
  const double radius = ball.radius * (1.0 + 1e-12) + 1e-13 * (glm::length(from) + glm::length(line.point));
  const double under = radius * radius - glm::dot(aside, aside);
  if (!(under >= 0.0)) {
    stretch.close();
    return stretch;
  }
  const double reach = std::sqrt(under / square) * (1.0 + 1e-12);
  stretch.in = nearest - reach;
  stretch.out = std::min(nearest + reach, (begins - line.clock.start) / line.clock.rate);
  return stretch;
}

}  // namespace

void inside_ball(const MatterMotion& motion, const LocalLines& lines,
                 Stretch (&stretches)[LocalLines::most]) {
  const MatterMotion::Ball& ball = *motion.ball();
  const LineStart first = start_of(lines, 0);
  double apart = 0.0;
  bool light = true;
  for (std::size_t i = 0; i < lines.count && light; ++i) {
    const LineStart start = start_of(lines, i);
    apart = std::max(apart, glm::length(start.place - first.place) + std::abs(start.time - first.time));
    light = is_light(lines.line(i));
  }
  if (!light) {
    for (std::size_t i = 0; i < lines.count; ++i) stretches[i] = inside_ball(motion, lines.line(i));
    return;
  }
  const Passing passing = passing_of_light(motion, first.place, first.time, apart);
  for (std::size_t i = 0; i < lines.count; ++i) {
    stretches[i] = inside_passing(passing, lines.line(i), ball.begins);
  }
}

BoundingSphere seen_from(const MatterMotion& motion, const Vec3& place, double time) {
  const Passing passing = passing_of_light(motion, place, time, 0.0);
  const double size = glm::length(passing.centre - place) + std::abs(time);
  const double radius = passing.radius + glm::length(passing.velocity) * passing.half_time;
  return {passing.centre, radius * (1.0 + 1e-9) + 1e-12 * size};
}

}  // namespace backlight
