#include "backlight/surface/matter_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "backlight/base/thread_memory.h"
#include "backlight/expression/compose.h"
#include "backlight/expression/enclosure.h"
#include "backlight/surface/implicit.h"
#include "lane_path.h"
#include "own_time.h"

namespace backlight {
namespace {

Vec3 values_of(const MatterMotion::Map& map, const Vec3& x, double seconds) {
  const std::array<double, 4> at{x.x, x.y, x.z, seconds};
  return {map[0].evaluate(at), map[1].evaluate(at), map[2].evaluate(at)};
}

/// The map's values and their rates of change, x changing at the rate `v`.
MatterMotion::Centre rates_of(const MatterMotion::Map& map, const Vec3& x, const Vec3& v, double seconds,
                              double rate) {
  const std::array<Dual, 4> at{Dual{x.x, v.x}, Dual{x.y, v.y}, Dual{x.z, v.z}, Dual{seconds, rate}};
  MatterMotion::Centre result;
  for (int i = 0; i < 3; ++i) {
    const Dual value = map[static_cast<std::size_t>(i)].evaluate(std::span<const Dual>(at));
    result.place[i] = value.value;
    result.velocity[i] = value.derivative;
  }
  return result;
}

/// What the three formulas have in common is computed once.
LineProgram as_one(const MatterMotion::Map& map) {
  Composer composer(ImplicitFormula::variables);
  const std::array<Composer::Node, 4> at{composer.variable(0), composer.variable(1), composer.variable(2),
                                         composer.variable(3)};
  std::array<Composer::Node, 3> results{};
  for (std::size_t i = 0; i < 3; ++i) results[i] = composer.insert(map[i], at);
  return LineProgram(composer.tape(results));
}

/// Work memory of one thread: of up to a window of places.
struct Places {
  static constexpr std::size_t window = 64;
  LineBatch at{window};
  std::vector<double> workspace;
  double value[3][window], slope[3][window];

  /// The values of three results and their rates, where places and times change as the batch says.
  void evaluate(const LineProgram& program, std::size_t count) {
    const std::array<LineNumbers, 3> results{
        {{value[0], slope[0]}, {value[1], slope[1]}, {value[2], slope[2]}}};
    program.all_numbers(at, count, workspace, results);
  }
};

Places& places_of_thread() {
  static constinit thread_local ThreadMemory<Places> memory;
  return memory.get();
}

}  // namespace

MatterMotion::MatterMotion(Body body, const Shape& body_shape, std::optional<Ball> ball, Time time)
    : body_(std::move(body)),
      place_(as_one(body_->place)),
      point_(as_one(body_->point)),
      body_shape_(body_shape),
      ball_(std::move(ball)),
      time_(time) {
  if (ball_) waves_ = WavePath::of(ball_->path, time_.seconds_per_length);
  if (!waves_) return;
  path_ = waves_->lanes();
  path_.speed = std::min(path_.speed, ball_->speed);
}

MatterMotion::MatterMotion(const Vec3& velocity, double radius, Time time)
    : carriage_(velocity),
      ball_(Ball{{}, radius, glm::length(velocity)}),
      waves_(WavePath::straight(velocity)),
      path_(waves_->lanes()),
      time_(time) {}

MatterMotion::MatterMotion(Map velocity, Time time) : velocity_(std::move(velocity)), time_(time) {}

MatterMotion::Matter MatterMotion::matter(const Vec3& place, double time) const {
  Matter found;
  matter({&place, 1}, {&time, 1}, {&found, 1});
  return found;
}

void MatterMotion::matter(std::span<const Vec3> places, std::span<const double> times,
                          std::span<Matter> found) const {
  if (!body_) {
    for (std::size_t i = 0; i < places.size(); ++i)
      found[i] = {places[i], given_velocity(places[i], times[i])};
    return;
  }
  Places& memory = places_of_thread();
  for (std::size_t first = 0; first < places.size(); first += Places::window) {
    const std::size_t count = std::min(Places::window, places.size() - first);
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3& x = places[first + k];
      memory.at.put(k, {x.x, x.y, x.z, time_.seconds_per_length * times[first + k]}, {}, 0.0, 0.0);
    }
    memory.evaluate(*point_, count);
    for (std::size_t k = 0; k < count; ++k)
      found[first + k].body_point = {memory.value[0][k], memory.value[1][k], memory.value[2][k]};
    find_velocities(times.subspan(first, count), found.subspan(first, count));
  }
}

/// Of no more than a window of body points.
void MatterMotion::find_velocities(std::span<const double> times, std::span<Matter> found) const {
  Places& memory = places_of_thread();
  const double rate = time_.seconds_per_length;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Vec3& x = found[k].body_point;
    const double seconds = rate * times[k];
    const Vec3 within = body_->flow ? rate * values_of(*body_->flow, x, seconds) : Vec3{0.0};
    memory.at.put(k, {x.x, x.y, x.z, seconds}, {within.x, within.y, within.z, rate}, 0.0, 0.0);
  }
  memory.evaluate(*place_, found.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    found[k].velocity = {memory.slope[0][k], memory.slope[1][k], memory.slope[2][k]};
}

Vec3 MatterMotion::velocity_of(const Vec3& point, double time) const {
  Matter found{point, {}};
  find_velocities({&time, 1}, {&found, 1});
  return found.velocity;
}

Vec3 MatterMotion::given_velocity(const Vec3& place, double time) const {
  return values_of(*velocity_, place, time_.seconds_per_length * time) * time_.seconds_per_length;
}

double MatterMotion::own_time(const Vec3& place, double time, const Mat3& rest_from_local) const {
  if (!body_ || body_->flow) {
    const auto flow = [this](const Vec3& at, double when) { return matter(at, when).velocity; };
    return own_time_of_flow(flow, rest_from_local, place, time);
  }
  const Vec3 point = matter(place, time).body_point;
  if (body_->steady) return time * clock_rate(rest_from_local * velocity_of(point, time));
  const auto period = body_->period ? std::optional(*body_->period / time_.seconds_per_length) : std::nullopt;
  return own_time_along([&](double when) { return rest_from_local * velocity_of(point, when); }, time,
                        period);
}

/// How far the centre's velocity is from this one at most, between two times.
double MatterMotion::change_of_velocity(const Vec3& velocity, double from, double to) const {
  constexpr std::array<double, 4> origin{};
  constexpr std::array<double, 4> direction{0.0, 0.0, 0.0, 1.0};
  const double scale = time_.seconds_per_length;
  double square = 0.0;
  for (int i = 0; i < 3; ++i) {
    const Expression& path = ball_->path[static_cast<std::size_t>(i)];
    const IntervalSlope range =
        enclose(path.tape(), {origin, direction}, scale * std::max(from, ball_->begins), scale * to);
    const double off =
        std::max(range.slope.upper * scale - velocity[i], velocity[i] - range.slope.lower * scale);
    square += off * off;
  }
  // No velocity is larger than the ball's.
  return std::min(std::sqrt(square), 2.0 * ball_->speed);
}

double MatterMotion::strays(const Vec3& velocity, double time, double half_time) const {
  if (!waves_) return half_time * change_of_velocity(velocity, time - half_time, time + half_time);
  return half_time * std::min(0.5 * waves_->most_acceleration() * half_time, 2.0 * waves_->most_speed());
}

MatterMotion::Centre MatterMotion::near_centre(double time) const {
  return waves_ ? moment_of(path_, time) : centre(time);
}

MatterMotion::Centre MatterMotion::centre(double time) const {
  if (carriage_) return moment_of(path_, time);
  return rates_of(ball_->path, Vec3{0.0}, Vec3{0.0}, time_.seconds_per_length * time,
                  time_.seconds_per_length);
}

Vec3 MatterMotion::farthest() const {
  const bool stays = waves_->velocity() == Vec3{0.0};  // but for waves
  if (!stays) return Vec3{std::numeric_limits<double>::infinity()};
  return glm::abs(waves_->start()) + waves_->farthest() + Vec3(ball_->radius);
}

}  // namespace backlight
