#include "aboard.h"

#include <algorithm>
#include <cmath>

#include "compile_motion.h"
#include "motion_levels.h"
#include "speed_proof.h"
#include "words.h"

namespace backlight {
namespace {

const Node* object_called(const Compilation& c, const std::string& name, std::vector<std::string>& names) {
  const Entry* objects = find(c.values.description.root, "object");
  if (objects == nullptr || objects->node.array() == nullptr) return nullptr;
  for (const Node& node : *objects->node.array()) {
    const Entry* entry = find(node, "name");
    if (entry == nullptr || entry->node.text() == nullptr) continue;
    if (*entry->node.text() == name) return &node;
    names.push_back(*entry->node.text());
  }
  return nullptr;
}

/// A body point in its frame, at a time of that (times c).
struct Passenger {
  Vec3 place;
  Vec3 velocity;
  Mat3 axes{1.0};  ///< of the body, stretched as it is
};

Passenger at_time(const MatterMotion::Body& body, const Vec3& point, double seconds, double c) {
  Passenger passenger;
  for (int i = 0; i < 3; ++i) {
    for (int along = 0; along < 4; ++along) {
      std::array<Dual, 4> at{Dual{point.x, 0.0}, Dual{point.y, 0.0}, Dual{point.z, 0.0}, Dual{seconds, 0.0}};
      at[static_cast<std::size_t>(along)].derivative = along < 3 ? 1.0 : 1.0 / c;
      const Dual value = body.place[static_cast<std::size_t>(i)].evaluate(std::span<const Dual>(at));
      passenger.place[i] = value.value;
      (along < 3 ? passenger.axes[along][i] : passenger.velocity[i]) = value.derivative;
    }
  }
  return passenger;
}

/// The root of a function that grows, from a first guess, by Newton's method. `f` gives value and slope.
template <class F>
double root_of(const F& f, double guess) {
  for (int i = 0; i < 200; ++i) {
    const auto [value, slope] = f(guess);
    const double next = guess - value / slope;
    if (next == guess || !std::isfinite(next)) return next;
    if (std::abs(next - guess) <= 4e-16 * std::abs(next)) return next;
    guess = next;
  }
  return guess;
}

// The clock of a thing aboard counts √(1 - v²) of its frame's time, and the world's γ + u·v.
double time_of_exposure(const TableView& camera, const MatterMotion& motion, const MatterMotion::Body& body,
                        const Vec3& point, const InertialFrame& base, double c) {
  const auto at = [&](double time) { return at_time(body, point, time / c, c); };
  if (camera.one_of({"time", "world_time"}) == "world_time") {
    const double wanted = c * camera.number("world_time") - double(base.origin.t);
    const double gamma = double(lorentz_factor(base.celerity));
    const Vec3 u = base.celerity.rounded();
    const auto late = [&](double time) {
      const Passenger here = at(time);
      return std::pair{gamma * time + glm::dot(u, here.place) - wanted, gamma + glm::dot(u, here.velocity)};
    };
    return root_of(late, wanted / gamma);
  }
  const double wanted = c * camera.number("time");
  const auto late = [&](double time) {
    const Passenger here = at(time);
    return std::pair{motion.own_time(here.place, time, Mat3(1.0)) - wanted,
                     std::sqrt(std::max(1e-12, 1.0 - glm::dot(here.velocity, here.velocity)))};
  };
  return root_of(late, wanted);
}

}  // namespace

bool ride(Compilation& c, const TableView& camera) {
  if (!camera.has_valid("aboard")) return false;
  for (const char* key : {"frame", "velocity", "beta", "gamma", "celerity", "rapidity", "rocket"}) {
    if (camera.has(key)) {
      camera.error(
          key, std::string("a camera aboard an object moves with that, and has no '") + key + "' besides");
    }
  }
  if (const Node* place = camera.node_of("position");
      place != nullptr && uses_time(c.values.description, *place)) {
    camera.error(
        "position", "aboard, the camera is fixed in one place, and 'position' may not depend on t",
        "image_time instead of t puts it somewhere else for each image; what walks about can be an object, "
        "and the camera aboard that");
  }
  std::vector<std::string> names;
  const Node* node = object_called(c, camera.text("aboard"), names);
  if (node == nullptr) {
    const std::string hint = did_you_mean(camera.text("aboard"), names);
    camera.error("aboard", "there is no object called '" + camera.text("aboard") + "'",
                 !hint.empty()   ? hint
                 : names.empty() ? ""
                                 : "their names are " + listed(names, "and"));
    return true;
  }
  if (c.values.diagnostics.has_errors()) return true;
  const TableView object(c.values, node, *find_table("object"));
  MotionLevel level = level_of(object);
  InertialFrame base = c.frames.named(object.text("frame"));
  if (has_motion(object)) {
    base = c.frames.own_motion(object).value_or(InertialFrame{});
    level.position = constant_formulas(base == InertialFrame{} ? object.vector("position") : Vec3{0.0});
  }
  take_rocket(object, c.scene.c, level);
  const Vec3 point = camera.vector("position");
  const MatterMotion::Body body = body_of({level});
  const MatterMotion motion(body, sphere(1.0), std::nullopt, {1.0 / c.scene.c, true});
  const double time = time_of_exposure(camera, motion, body, point, base, c.scene.c);
  // Faster than light it has no own time.
  const double when = std::isfinite(time) ? time : c.scene.c * camera.number("time");
  const Passenger here = at_time(body, point, when / c.scene.c, c.scene.c);
  const double speed = glm::length(here.velocity);
  if (!(speed < 1.0) || !std::isfinite(time)) {
    camera.error("position", "aboard, the camera would have |velocity| = " + number_text(speed * c.scene.c) +
                                 ", which is not below the speed of light, c = " + number_text(c.scene.c));
    return true;
  }
  const ExtendedVec3 velocity(here.velocity);
  const ExtendedVec3 celerity = (Extended(1.0) / sqrt(Extended(1.0) - dot(velocity, velocity))) * velocity;
  const ExtendedEvent event{Extended(time), ExtendedVec3(here.place)};
  CameraView& view = c.scene.camera;
  view.celerity = base == InertialFrame{} ? celerity : within(base, {celerity, event}).celerity;
  view.event = to_world(base, event);
  view.proper_time = motion.own_time(here.place, time, Mat3(1.0));
  // The body's axes as its matter measures them, so without the contraction along its way, carried by the
  // pure boost from its frame; in the camera's, which are carried from the world's.
  const Vec3 u = celerity.rounded();
  const Mat3 measured = Mat3(1.0) + glm::outerProduct(u, u) / (1.0 + std::sqrt(1.0 + glm::dot(u, u)));
  const Mat3 turn = relative_motion(view.celerity, base.celerity).rotation * measured * here.axes;
  Lens& lens = view.lens;
  if (!aim(lens, turn * lens.forward, turn * lens.up)) {
    camera.error("up", "aboard, the stretched axes leave the camera no upward direction");
  }
  return true;
}

}  // namespace backlight
