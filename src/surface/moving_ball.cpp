#include "moving_ball.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "passing_lanes.h"
#include "surface_kernels.h"

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
    const MatterMotion::Centre centre = motion.near_centre(time);
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
  const double room = 1e-12 * (ball.radius + std::abs(nearest) + glm::length(at.centre)) +
                      motion.near_centre_doubt(line.clock.start + at.s * line.clock.rate);
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
  if (line.clock.rate == 0.0 && line.clock.start < ball.begins) stretch.close();
  return stretch;
}

namespace {

Passing passing_at(const MatterMotion& motion, const MatterMotion::Centre& centre, double time,
                   double half_time) {
  const double strays = motion.strays(centre.velocity, time, half_time);
  const double doubt = motion.near_centre_doubt(std::abs(time) + half_time);
  return {time, half_time, centre.place, centre.velocity, motion.ball()->radius + strays + doubt};
}

Passing passing_between(const MatterMotion& motion, double first, double last) {
  const double time = 0.5 * first + 0.5 * last;
  const double half_time = 0.5 * (last - first) * (1.0 + 1e-9) + 1e-12 * std::abs(time);
  return passing_at(motion, motion.near_centre(time), time, half_time);
}

/// Of light that arrives at an event, or leaves it.
enum class Way { arrives, leaves };

struct Moments {
  double first, last;
};

/// Between these the centre is where light of the event meets it: the root of (29), which they enclose unless
/// it is off by no more than `enough`; or the moment from which on the motion is known.
/// `guess`: any moment.
Moments meeting_with_light(const MatterMotion& motion, const Vec3& place, double time, Way way, double enough,
                           double guess) {
  const MatterMotion::Ball& ball = *motion.ball();
  const double sign = way == Way::arrives ? -1.0 : 1.0;
  double low = way == Way::arrives ? -infinite : time;
  double high = way == Way::arrives ? time : infinite;
  double at = std::clamp(guess, std::max(low, ball.begins), std::max(high, ball.begins));
  constexpr int most_steps = 60;
  for (int i = 0; i < most_steps; ++i) {
    const MatterMotion::Centre centre = motion.near_centre(at);
    const Vec3 to = centre.place - place;
    const double length = glm::length(to);
    const double over = sign * (at - time) - length;  // the way of the light, over what it has to go
    if (!(std::abs(over) > enough)) return {at, at};
    (sign * over > 0.0 ? high : low) = at;
    const double toward = length > 0.0 ? glm::dot(to, centre.velocity) / length : 0.0;
    const double next = at - over / (sign - toward);
    const bool bounded = std::isfinite(low) && std::isfinite(high);
    const double farther = at + sign * 2.0 * std::abs(over) / (1.0 - ball.speed);
    const double within = next > low && next < high ? next : bounded ? 0.5 * low + 0.5 * high : farther;
    if (within < ball.begins) return {ball.begins, ball.begins};
    at = within;
  }
  return {std::max(low, ball.begins), high};
}

/// Whether it is found, and all of it is of moments that count.
bool is_known(const MatterMotion::Ball& ball, const Passing& passing, double until) {
  return passing.half_time < infinite && passing.time - passing.half_time > ball.begins &&
         passing.time + passing.half_time < until;
}

/// The passing that light of an event meets, and of others no farther than `apart` from it; no later than
/// `until`. Of light within r of the centre at t, |h(t)| <= r + apart with the h of (29), which is monotone:
/// between its roots for times that much earlier and later.
Passing passing_of_light(const MatterMotion& motion, const Vec3& place, double time, Way way, double apart,
                         double until = infinite) {
  const MatterMotion::Ball& ball = *motion.ball();
  const double doubt = 0.03 * (ball.radius + apart);
  const double reach =
      ball.radius + apart + 2.0 * (doubt + motion.near_centre_doubt(time)) + 1e-12 * std::abs(time);
  double early = time - reach;
  if (motion.is_quick()) {
    using One = Lanes<1>;
    const LanePassing<One> lane =
        passing_of(*motion.path(), One(ball.radius),
                   EventLight<One>{one_lane(place), One(time), One(apart), way == Way::arrives ? -1.0 : 1.0});
    const Passing passing{lane.time.v, lane.half_time.v, vec3(lane.centre), vec3(lane.velocity),
                          lane.radius.v};
    if (is_known(ball, passing, until)) return passing;
    if (std::isfinite(passing.time)) early = passing.time - reach;
  }
  const double first = meeting_with_light(motion, place, time - reach, way, doubt, early).first;
  const double soon = first + 2.0 * reach;
  const double last = std::min(until, meeting_with_light(motion, place, time + reach, way, doubt, soon).last);
  return passing_between(motion, first, last);
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

/// By the passing of the moments within a stretch, which are fewer than those of all lines.
void narrow(const MatterMotion& motion, const LocalLine& line, Stretch& stretch) {
  const double middle = line.clock.start + (0.5 * stretch.in + 0.5 * stretch.out) * line.clock.rate;
  const double half = 0.5 * (stretch.out - stretch.in) * std::abs(line.clock.rate);
  const Passing passing = passing_between(motion, middle - half, middle + half);
  const Stretch within = inside_passing(passing, line, motion.ball()->begins);
  stretch.in = std::max(stretch.in, within.in);
  stretch.out = std::min(stretch.out, within.out);
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
  const Passing passing = light ? passing_of_light(motion, first.place, first.time, Way::arrives, apart)
                                : Passing{.half_time = infinite};
  if (!(passing.half_time < infinite)) {
    for (std::size_t i = 0; i < lines.count; ++i) stretches[i] = inside_ball(motion, lines.line(i));
    return;
  }
  const bool strays = motion.is_quick() && passing.radius > 1.05 * ball.radius;
  for (std::size_t i = 0; i < lines.count; ++i) {
    const LocalLine line = lines.line(i);
    stretches[i] = inside_passing(passing, line, ball.begins);
    if (strays && stretches[i].in <= stretches[i].out) narrow(motion, line, stretches[i]);
  }
}

namespace {

BoundingSphere sphere_of(const Passing& passing, const Vec3& place, double time) {
  const double size = glm::length(passing.centre - place) + std::abs(time);
  const double radius = passing.radius + glm::length(passing.velocity) * passing.half_time;
  return {passing.centre, radius * (1.0 + 1e-9) + 1e-12 * size};
}

}  // namespace

Passing passing_seen_from(const MatterMotion& motion, const Vec3& place, double time) {
  return passing_of_light(motion, place, time, Way::arrives, 0.0);
}

Passing passing_lit_from(const MatterMotion& motion, const LightFlash& flash) {
  return passing_of_light(motion, flash.place, flash.time, Way::leaves, flash.apart, flash.until);
}

BoundingSphere seen_from(const MatterMotion& motion, const Vec3& place, double time) {
  return sphere_of(passing_seen_from(motion, place, time), place, time);
}

BoundingSphere sphere_of(const Passing& passing, const LightFlash& flash) {
  if (passing.half_time < 0.0) return {};
  return sphere_of(passing, flash.place, flash.time);
}

BoundingSphere lit_from(const MatterMotion& motion, const LightFlash& flash) {
  return sphere_of(passing_lit_from(motion, flash), flash);
}

PassingBall ball_of(const Passing& passing, const Vec3& about) {
  PassingBall ball{.time = passing.time, .radius = passing.radius};
  for (int k = 0; k < 3; ++k) {
    ball.centre[k] = about[k] + passing.centre[k];
    ball.velocity[k] = passing.velocity[k];
  }
  return ball;
}

void passings_lit_from(std::span<const MatterMotion* const> motions, std::span<const LightFlash> flashes,
                       std::span<Passing> passings) {
  PassingSheet sheet;
  std::array<std::size_t, PassingSheet::most> row;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const LanePath* path = motions[i]->path();
    if (path == nullptr || path->count > LanePaths<Lanes<1>>::most_turns) {
      passings[i] = passing_lit_from(*motions[i], flashes[i]);
      continue;
    }
    const int at = sheet.count++;
    row[static_cast<std::size_t>(at)] = i;
    sheet.path[at] = path;
    sheet.radius[at] = motions[i]->ball()->radius;
    for (int k = 0; k < 3; ++k) sheet.place[k][at] = flashes[i].place[k];
    sheet.start[at] = flashes[i].time;
    sheet.apart[at] = flashes[i].apart;
  }
  surface_kernels().find_passings(sheet);
  for (int at = 0; at < sheet.count; ++at) {
    const std::size_t i = row[static_cast<std::size_t>(at)];
    Passing& passing = passings[i];
    passing = {.time = sheet.time[at], .half_time = sheet.half_time[at], .radius = sheet.reach[at]};
    for (int k = 0; k < 3; ++k) {
      passing.centre[k] = sheet.centre[k][at];
      passing.velocity[k] = sheet.velocity[k][at];
    }
    if (!is_known(*motions[i]->ball(), passing, flashes[i].until)) {
      passing = passing_lit_from(*motions[i], flashes[i]);
    }
  }
}

}  // namespace backlight
