#include "backlight/surface/matter_motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "backlight/expression/enclosure.h"
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

}  // namespace

MatterMotion::MatterMotion(Body body, const Shape& body_shape, std::optional<Ball> ball, Time time)
    : body_(std::move(body)), body_shape_(body_shape), ball_(std::move(ball)), time_(time) {
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

Vec3 MatterMotion::body_point(const Vec3& place, double time) const {
  return body_ ? values_of(body_->point, place, time_.seconds_per_length * time) : place;
}

Vec3 MatterMotion::velocity_of(const Vec3& point, double time) const {
  const double rate = time_.seconds_per_length, seconds = rate * time;
  const Vec3 within = body_->flow ? rate * values_of(*body_->flow, point, seconds) : Vec3{0.0};
  return rates_of(body_->place, point, within, seconds, rate).velocity;
}

Vec3 MatterMotion::given_velocity(const Vec3& place, double time) const {
  return values_of(*velocity_, place, time_.seconds_per_length * time) * time_.seconds_per_length;
}

Vec3 MatterMotion::velocity(const Vec3& place, double time) const {
  return body_ ? velocity_of(body_point(place, time), time) : given_velocity(place, time);
}

double MatterMotion::own_time(const Vec3& place, double time, const Mat3& rest_from_local) const {
  if (!body_ || body_->flow) {
    const auto flow = [this](const Vec3& at, double when) { return velocity(at, when); };
    return own_time_of_flow(flow, rest_from_local, place, time);
  }
  const Vec3 point = body_point(place, time);
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
