#include "camera_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "words.h"

namespace backlight {
namespace {

// A point of a path in the coordinates of the frame that it is written in, and how fast it goes by there.
struct PathPoint {
  Extended time;  // times c
  Vec3 position{0.0};
  double time_rate = 0.0;  // by t, times c
  Vec3 position_rate{0.0};

  [[nodiscard]] bool moves() const { return position_rate != Vec3{0.0}; }
  [[nodiscard]] double speed() const { return glm::length(position_rate) / std::abs(time_rate); }
  [[nodiscard]] Vec3 velocity() const { return position_rate / time_rate; }
};

PathPoint path_point(const TableView& camera, const InertialFrame& base, double c) {
  PathPoint point;
  const std::array<Dual, 3> position = camera.moving_vector("position");
  for (int i = 0; i < 3; ++i) {
    point.position[i] = position[static_cast<std::size_t>(i)].value;
    point.position_rate[i] = position[static_cast<std::size_t>(i)].derivative;
  }
  if (camera.one_of({"time", "world_time"}) != "world_time") {
    const Dual time = camera.moving_number("time");
    point.time = Extended(c) * Extended(time.value);
    point.time_rate = c * time.derivative;
    return point;
  }
  // t_W = t_origin + γ t' + u·x' solved for t'.
  const Dual world_time = camera.moving_number("world_time");
  const Extended gamma = lorentz_factor(base.celerity);
  const ExtendedVec3 at(point.position);
  point.time = (Extended(c) * Extended(world_time.value) - base.origin.t - dot(base.celerity, at)) / gamma;
  point.time_rate =
      (c * world_time.derivative - glm::dot(base.celerity.rounded(), point.position_rate)) / double(gamma);
  return point;
}

// The point for another value of t, as if an image were made there.
PathPoint path_point_at(const Description& description, const ImageRequest& request, const Frames& frames,
                        double c, double t) {
  Diagnostics ignored;
  ImageRequest other = request;
  other.frame.reset();
  other.time = t;
  ImageValues values = image_values(description, other, ignored);
  const TableView camera(values, find_camera(values, other), *find_table("camera"));
  return path_point(camera, frames.named(camera.text("frame")), c);
}

// Equation (18): what the camera's clock has counted since t = 0, by Gauss and Legendre's rule of five points
// on many short pieces. Reported in the header only.
double proper_time(const Compilation& c, double t) {
  constexpr std::array<double, 5> nodes{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                        0.9061798459386640};
  constexpr std::array<double, 5> weights{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                          0.4786286704993665, 0.2369268850561891};
  constexpr int pieces = 32;
  const double half = 0.5 * t / pieces;
  double sum = 0.0;
  for (int piece = 0; piece < pieces; ++piece) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double at = half * (2.0 * piece + 1.0 + nodes[i]);
      const PathPoint p = path_point_at(c.values.description, c.request, c.frames, c.scene.c, at);
      const double square = p.time_rate * p.time_rate - glm::dot(p.position_rate, p.position_rate);
      sum += weights[i] * half * std::sqrt(std::max(square, 0.0)) * (p.time_rate < 0.0 ? -1.0 : 1.0);
    }
  }
  return sum;
}

std::string too_fast(double speed, double c, double t) {
  const std::string shown = std::isfinite(speed) ? number_text(speed * c) : std::string("infinite");
  return "the camera's path has |velocity| = " + shown + " at t = " + number_text(t) +
         ", which is not below the speed of light, c = " + number_text(c);
}

constexpr const char* too_fast_hint =
    "the velocity is derived from 'position'; write velocity = [0, 0, 0] for a camera at rest in each image";

// The flight's rapidity when the world's clock shows `world_time`: A sinh s + B cosh s = C with A > |B|.
Extended rapidity_at(Extended a, Extended b, Extended c) {
  const Extended root = sqrt(c * c + (a - b) * (a + b));
  const Extended y = c < Extended(0.0) ? (a - b) / (root - c) : (c + root) / (a + b);
  Extended s(std::log(double(y)));
  return s + (y * exp(-s) - Extended(1.0));  // one step of Newton's
}

}  // namespace

std::optional<ExtendedVec3> thrust_direction(const TableView& rocket) {
  const Vec3 along = rocket.vector("along");
  const double length = glm::length(along);
  if (length > 0.0 && std::isfinite(length)) {
    const ExtendedVec3 exact(along);
    return (Extended(1.0) / sqrt(dot(exact, exact))) * exact;
  }
  rocket.error("along", "'along' is zero: it has no direction");
  return std::nullopt;
}

bool follow_path(Compilation& c, const TableView& camera) {
  if (has_motion(camera) || c.values.diagnostics.has_errors()) return false;
  const InertialFrame& base = c.frames.named(camera.text("frame"));
  const PathPoint point = path_point(camera, base, c.scene.c);
  if (!point.moves()) return false;
  const double speed = point.speed();
  if (!(speed < 1.0)) {
    camera.error("position", too_fast(speed, c.scene.c, c.values.variables[0]), too_fast_hint);
    return true;
  }
  const ExtendedVec3 velocity(point.velocity());
  const ExtendedEvent here{point.time, ExtendedVec3(point.position)};
  const ExtendedVec3 celerity = (Extended(1.0) / sqrt(Extended(1.0) - dot(velocity, velocity))) * velocity;
  const InertialFrame own{celerity, here};
  c.scene.camera.celerity = base == InertialFrame{} ? celerity : within(base, own).celerity;
  c.scene.camera.event = to_world(base, here);
  c.scene.camera.proper_time = proper_time(c, c.values.variables[0]);
  return true;
}

bool fly(Compilation& c, const TableView& camera) {
  if (!camera.has_valid("rocket")) return false;
  const TableView rocket = camera.table("rocket", "rocket");
  const auto along = rocket.complete() ? thrust_direction(rocket) : std::nullopt;
  if (!along) return true;
  // The frame in which it begins, at rest at `start`.
  InertialFrame base = c.frames.named(camera.text("frame"));
  ExtendedVec3 start(camera.vector("position"));
  if (has_motion(camera)) {
    if (camera.has("frame")) camera.error("frame", "a camera has a frame or a velocity of its own, not both");
    base = InertialFrame{read_celerity(camera, c.scene.c), {Extended(0.0), start}};
    start = ExtendedVec3{};
  }
  const Extended light(c.scene.c);
  const Extended radius = light * light / Extended(rocket.number("acceleration"));  // c²/a
  Extended rapidity = light * Extended(camera.number("time")) / radius;
  if (camera.one_of({"time", "world_time"}) == "world_time") {
    const Extended since =
        light * Extended(camera.number("world_time")) - base.origin.t - dot(base.celerity, start);
    const Extended drift = dot(base.celerity, *along);
    rapidity = rapidity_at(lorentz_factor(base.celerity), drift, since / radius + drift);
  }
  const Extended half = sinh(Extended(0.5) * rapidity);
  const Extended way = Extended(2.0) * radius * half * half;  // (20), without cancellation
  const ExtendedEvent here{radius * sinh(rapidity), start + way * *along};
  const InertialFrame own{sinh(rapidity) * *along, here};
  c.scene.camera.celerity = base == InertialFrame{} ? own.celerity : within(base, own).celerity;
  c.scene.camera.event = to_world(base, here);
  c.scene.camera.proper_time = double(rapidity * radius);
  const Vec3 u = c.scene.camera.celerity.rounded();
  if (!std::isfinite(u.x + u.y + u.z) || !std::isfinite(double(c.scene.camera.event.t))) {
    rocket.error("acceleration", "the rocket's rapidity is " + number_text(double(rapidity)) +
                                     " at t = " + number_text(c.values.variables[0]) +
                                     ", which is too much to compute with");
  }
  return true;
}

void check_camera_path(const Description& description, const ImageRequest& request,
                       Diagnostics& diagnostics) {
  const std::vector<int> frames = animation_frames(description);
  if (frames.size() < 2) return;
  Diagnostics ignored;
  ImageValues values = image_values(description, request, ignored);
  const TableView camera(values, find_camera(values, request), *find_table("camera"));
  if (has_motion(camera) || camera.has("rocket")) return;
  const double c = TableView(values, &description.root, *find_table("")).number("c");
  std::vector<SceneFrame> scene_frames;
  const Frames rest_frames(values, c, scene_frames);
  const auto speed = [&](double t) {
    const PathPoint point = path_point_at(description, request, rest_frames, c, t);
    return point.moves() ? point.speed() : 0.0;
  };
  const auto time_of = [&](int frame) {
    ImageRequest other = request;
    other.frame = frame;
    return image_values(description, other, ignored).variables[0];
  };
  const double first = time_of(frames.front());
  const double last = time_of(frames.back());
  const std::size_t steps = std::min<std::size_t>((frames.size() - 1) * 8, 20000);
  double before = first;
  for (std::size_t i = 0; i <= steps; ++i) {
    double instant = first + (last - first) * static_cast<double>(i) / static_cast<double>(steps);
    if (speed(instant) < 1.0) {
      before = instant;
      continue;
    }
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (before + instant);
      (speed(middle) < 1.0 ? before : instant) = middle;
    }
    diagnostics.error(description.span(camera.place("position")), too_fast(speed(instant), c, instant),
                      too_fast_hint);
    return;
  }
}

}  // namespace backlight
