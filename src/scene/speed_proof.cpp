#include "speed_proof.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "backlight/expression/enclosure.h"
#include "backlight/surface/implicit.h"
#include "backlight/surface/placement.h"
#include "backlight/surface/surface_set.h"
#include "backlight/surface/wave_path.h"
#include "words.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double size_of(double lower, double upper) {
  return lower <= upper ? std::max(std::abs(lower), std::abs(upper)) : infinity;
}

/// Bounds of |values| and |rates| of three formulas over some times.
struct Sizes {
  Vec3 value{0.0};
  Vec3 rate{0.0};
};

Sizes sizes_of(const std::array<Expression, 3>& formulas, double from, double to) {
  Sizes sizes;
  if (const auto constant = constants_of(formulas)) return {glm::abs(*constant), Vec3{0.0}};
  for (int i = 0; i < 3; ++i) {
    const IntervalSlope range = over_times(formulas[static_cast<std::size_t>(i)], from, to);
    const bool smooth = range.value.continuity == Continuity::continuous;
    sizes.value[i] = smooth ? size_of(range.value.lower, range.value.upper) : infinity;
    sizes.rate[i] = smooth ? size_of(range.slope.lower, range.slope.upper) : infinity;
  }
  return sizes;
}

double largest(const Vec3& v) {
  return std::max({v.x, v.y, v.z});
}

double farthest(const std::vector<HullBall>& hull) {
  double reach = 0.0;
  for (const HullBall& ball : hull) reach = std::max(reach, glm::length(ball.centre) + ball.radius);
  return reach;
}

/// How far the hull reaches from the line through the origin along `axis`.
double reach_from(const Vec3& axis, const std::vector<HullBall>& hull) {
  double reach = 0.0;
  for (const HullBall& ball : hull) {
    reach = std::max(reach, glm::length(glm::cross(axis, ball.centre)) + ball.radius);
  }
  return reach;
}

std::vector<HullBall> placed(const std::vector<HullBall>& hull, const Placement& placement) {
  std::vector<HullBall> result;
  for (const HullBall& ball : hull) {
    result.push_back({placement.position() + placement.rest_from_local() * ball.centre,
                      largest(glm::abs(placement.scale())) * ball.radius});
  }
  return result;
}

/// The hull with a constant rotation and scale, or what is turned and stretched in any way.
std::vector<HullBall> stretched(const std::vector<HullBall>& hull, const MotionLevel& level,
                                const Sizes& scale) {
  if (const auto constant = constants_of(level.scale))
    return placed(hull, Placement(Vec3{0.0}, Vec3{0.0}, *constant));
  double reach = 0.0;
  for (const HullBall& ball : hull) {
    reach = std::max(reach,
                     glm::length(glm::abs(ball.centre) * scale.value) + largest(scale.value) * ball.radius);
  }
  return {{Vec3{0.0}, reach}};
}

/// What turning adds to the speed: for each angle its rate times the distance from its axis, which those
/// inside of it have turned the hull about.
double turning_speed(const MotionLevel& level, const Sizes& rotate, std::vector<HullBall> hull) {
  double speed = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 about{0.0};
    about[axis] = 1.0;
    speed += rotate.rate[axis] * (std::numbers::pi / 180.0) * reach_from(about, hull);
    Vec3 angles{0.0};
    const auto constant = level.rotate[static_cast<std::size_t>(axis)].constant();
    if (constant) {
      angles[axis] = *constant;
      hull = placed(hull, Placement(Vec3{0.0}, angles, Vec3{1.0}));
    } else {
      hull = {{Vec3{0.0}, farthest(hull)}};
    }
  }
  return speed;
}

/// The least ξ of a hull.
double least_distance(const RocketFlight& rocket, const std::vector<HullBall>& hull) {
  double least = infinity;
  for (const HullBall& ball : hull) {
    least = std::min(least, 1.0 / rocket.acceleration + glm::dot(ball.centre, rocket.along) - ball.radius);
  }
  return least;
}

/// Of the point with least ξ, at a time of the frame; 1 where there is none that can fly so.
double flight_speed(const RocketFlight& rocket, const std::vector<HullBall>& hull, double time) {
  const double least = least_distance(rocket, hull);
  const double way = rocket.c * time;
  return least > 0.0 ? way / std::hypot(least, way) : 1.0;
}

/// Whether no light of a body in flight, before a time (all times in lengths) when it was in `ball`, gets to
/// the origin at the time `last`. `start`: the place from which ξ = 1/a is counted. Along the thrust the body
/// is contracted.
bool is_seen_later_of(const RocketFlight& rocket, const Vec3& start, const HullBall& ball, double time,
                      double last) {
  const double horizon =
      1.0 / rocket.acceleration - glm::dot(start, rocket.along);  // ξ of the origin at time 0
  if (horizon + last <= 0.0) return true;                         // no light of it at all
  const double along = glm::dot(ball.centre, rocket.along);
  const double aside = glm::length(ball.centre - along * rocket.along) + ball.radius;
  const double ahead = along + horizon;
  const double front = std::sqrt(std::max(0.0, (ahead - time) * (ahead + time))) + ball.radius;
  const double half_length = ball.radius * front / std::hypot(front, time);
  return std::hypot(std::abs(along) + half_length, aside) < last - time;
}

/// Bounds on single coordinates make nothing of a circle's being one: its speed is known at once.
double path_speed(const std::array<Expression, 3>& position, const Vec3& rate) {
  const double by_coordinates = glm::length(rate);
  if (by_coordinates == 0.0) return 0.0;
  const auto path = WavePath::of(position, 1.0);
  return path ? std::min(by_coordinates, path->most_speed()) : by_coordinates;
}

struct Speeds {
  double body;
  double centre;
};

/// Bounds over times in [from, to], in units of c: |v| <= |ċ| + Σ |α̇| ρ + |Ṡ X| + |S| v_inner, from the
/// inside outwards, where matter flows at `within` in the innermost.
Speeds speeds(const std::vector<MotionLevel>& levels, std::vector<HullBall> hull, double c, double within,
              double from, double to) {
  double body = within;
  double centre = 0.0;
  double centre_reach = 0.0;
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
    const Sizes position = sizes_of(level->position, from, to);
    const Sizes rotate = sizes_of(level->rotate, from, to);
    const Sizes scale = sizes_of(level->scale, from, to);
    const double stretching = largest(scale.rate) * farthest(hull);
    const double stretch = largest(scale.value);
    hull = stretched(hull, *level, scale);
    const double turning = turning_speed(*level, rotate, hull);
    // Equation (27): of a point at ξ, |ct|/√(ξ² + c²t²).
    const double path = level->rocket
                            ? c * flight_speed(*level->rocket, hull, std::max(std::abs(from), std::abs(to)))
                            : path_speed(level->position, position.rate);
    body = stretch * body + stretching + turning + path;
    const double angular = (rotate.rate.x + rotate.rate.y + rotate.rate.z) * (std::numbers::pi / 180.0);
    centre = stretch * centre + (largest(scale.rate) + angular * stretch) * centre_reach + path;
    centre_reach = stretch * centre_reach + glm::length(position.value);
    const auto at = constants_of(level->position);
    const auto turned = constants_of(level->rotate);
    hull = at && turned ? placed(hull, Placement(*at, *turned, Vec3{1.0}))
                        : std::vector<HullBall>{{Vec3{0.0}, farthest(hull) + glm::length(position.value)}};
  }
  return {body / c, std::min(centre, body) / c};
}

/// The corners of those cells of a box in which the surface may be at any time.
void add_cells(const ImplicitFormula& f, const Vec3& low, const Vec3& high, int depth,
               std::vector<HullBall>& hull) {
  const Interval value = f.range(low, high, {-always, always, Continuity::continuous});
  const bool is_empty = value.continuity == Continuity::undefined;
  if (is_empty || (value.continuity < Continuity::partial && (value.lower > 0.0 || value.upper < 0.0)))
    return;
  if (depth == 0) {
    const Vec3 middle = 0.5 * low + 0.5 * high;
    hull.push_back({middle, 0.5 * glm::length(high - low)});
    return;
  }
  const int axis = depth % 3;
  const double middle = 0.5 * low[axis] + 0.5 * high[axis];
  Vec3 below = high, above = low;
  below[axis] = above[axis] = middle;
  add_cells(f, low, below, depth - 1, hull);
  add_cells(f, above, high, depth - 1, hull);
}

}  // namespace

double stretch_of(const std::vector<MotionLevel>& levels, double from, double to) {
  double stretch = 1.0;
  for (const MotionLevel& level : levels) stretch *= largest(sizes_of(level.scale, from, to).value);
  return stretch;
}

IntervalSlope over_times(const Expression& formula, double from, double to) {
  constexpr std::array<double, 4> origin{};
  constexpr std::array<double, 4> direction{0.0, 0.0, 0.0, 1.0};
  return enclose(formula.tape(), VariableLine{origin, direction}, from, to);
}

std::vector<HullBall> hull_of(const Shape& shape) {
  const auto& v = shape.values;
  const auto box = [](const Vec3& low, const Vec3& high) {
    std::vector<HullBall> corners;
    for (int i = 0; i < 8; ++i) {
      corners.push_back(
          {{(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z}});
    }
    return corners;
  };
  std::vector<HullBall> hull;
  // A circle about y, within a polygon.
  const auto add_ring = [&hull](double radius, double y, double thick) {
    constexpr int corners = 4096;
    const double out = radius / std::cos(std::numbers::pi / corners);
    for (int i = 0; i < corners; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / corners;
      hull.push_back({{out * std::cos(angle), y, out * std::sin(angle)}, thick});
    }
  };
  switch (shape.kind) {
    case ShapeKind::sphere:
      return {{Vec3{0.0}, v[0]}};
    case ShapeKind::box:
      return box({-0.5 * v[0], -0.5 * v[1], -0.5 * v[2]}, {0.5 * v[0], 0.5 * v[1], 0.5 * v[2]});
    case ShapeKind::cylinder:
      add_ring(v[0], -0.5 * v[1], 0.0);
      add_ring(v[0], 0.5 * v[1], 0.0);
      return hull;
    case ShapeKind::cone:
      add_ring(v[0], -0.5 * v[2], 0.0);
      add_ring(v[1], 0.5 * v[2], 0.0);
      return hull;
    case ShapeKind::torus:
      add_ring(v[0], 0.0, v[1]);
      return hull;
    case ShapeKind::disk:
      add_ring(v[0], 0.0, 0.0);
      return hull;
    case ShapeKind::implicit: {
      constexpr int deepest = 15;  // cells of a 32nd of the bounds
      add_cells(*shape.formula, {v[0], v[1], v[2]}, {v[3], v[4], v[5]}, deepest, hull);
      return hull;
    }
    case ShapeKind::plane:
    case ShapeKind::quadric:
    case ShapeKind::csg:
    case ShapeKind::mesh:
    case ShapeKind::travelling_ball:
      break;
  }
  SurfaceSet one;
  one.add(shape, Placement{});
  return {{Vec3{0.0}, one.bounds(0).radius}};
}

SpeedProver::SpeedProver(Compilation& c, int frame) : c_(c) {
  const InertialFrame& its = c.scene.frames[static_cast<std::size_t>(frame)].motion;
  const CameraView& camera = c.scene.camera;
  const ExtendedEvent event = to_frame(its, camera.event);
  const double gamma = relative_motion(its.celerity, camera.celerity).gamma;
  const double aside = camera.stereo ? gamma * camera.stereo->separation : 0.0;  // of an eye's event
  camera_ = event.x.rounded();
  last_ = (double(event.t) + aside) / c.scene.c;
}

std::optional<SpeedProof> SpeedProver::prove(const TableView& table, const std::vector<MotionLevel>& levels,
                                             const std::vector<HullBall>& hull, const Vec3& offset,
                                             double within) const {
  const MatterMotion::Body body = body_of(levels);
  const double c = c_.scene.c;
  const auto body_at = [&](double time) {
    const std::array<double, 4> origin{0.0, 0.0, 0.0, time};
    Vec3 here = offset;
    for (int i = 0; i < 3; ++i) here[i] += body.place[static_cast<std::size_t>(i)].evaluate(origin);
    return HullBall{here - camera_, farthest(hull) * stretch_of(levels, time, last_)};
  };
  const std::optional<RocketFlight>& rocket = levels.front().rocket;
  const Vec3 start = offset + constants_of(levels.front().position).value_or(Vec3{0.0}) - camera_;
  // What was inside the past light cone then, with a speed below that of light since, was so ever before.
  const auto is_seen_later = [&](double time) {
    return rocket ? is_seen_later_of(*rocket, start, body_at(time), c * time, c * last_)
                  : farthest({body_at(time)}) < c * (last_ - time);
  };
  // Shadows are thrown by what was there before it is seen.
  const double reach = 16.0 * farthest({body_at(last_)}) / c;
  const auto is_enough = [&](double time) {
    constexpr double of_shadows = 4.0;
    constexpr double longest = 1000.0;  // what is seen from a thousand times as far is a point at most
    return is_seen_later(last_ - (last_ - time) / of_shadows) || (!rocket && time < last_ - longest * reach);
  };
  const SpeedProof proof = prove_speed(levels, hull, c, last_, reach, is_enough, within);
  if (std::isinf(proof.begins) || proof.begins <= last_ - reach || is_seen_later(proof.begins)) return proof;
  refuse(table, rocket, hull, proof);
  return std::nullopt;
}

void SpeedProver::refuse(const TableView& table, const std::optional<RocketFlight>& rocket,
                         const std::vector<HullBall>& hull, const SpeedProof& proof) const {
  if (rocket && !(least_distance(*rocket, hull) > 0.0)) {
    const double horizon = 1.0 / rocket->acceleration;
    return table.error("rocket",
                       "it reaches " + number_text(horizon - least_distance(*rocket, hull)) +
                           " behind 'position', and nothing can fly along from c²/acceleration = " +
                           number_text(horizon) + " behind that on",
                       "a smaller acceleration, or a body that reaches less far behind");
  }
  const char* key = "position";
  for (const char* written : {"scale", "rotate", "position"}) {
    const Node* node = table.node_of(written);
    if (node != nullptr && uses_time(c_.values.description, *node)) key = written;
  }
  const double c = c_.scene.c;
  const std::string bound = std::isfinite(proof.speed_before)
                                ? "the bound on its speed there is " + number_text(proof.speed_before * c)
                                : std::string("a formula may jump there, or has a pole (mod and floor jump)");
  table.error(key,
              "its matter cannot be shown to be slower than light, c = " + number_text(c) +
                  ", at t = " + number_text(proof.begins) + ": " + bound,
              "the velocity is derived from the formulas of t: max(t, 0) begins a motion at t = 0; "
              "image_time instead "
              "of t puts a thing somewhere else for each image");
}

bool uses_time(const Description& description, const Node& node) {
  if (const auto* formula = std::get_if<Expression>(&node.value)) return description.depends_on_t(*formula);
  const NodeArray* array = node.array();
  return array != nullptr &&
         std::ranges::any_of(*array, [&](const Node& one) { return uses_time(description, one); });
}

SpeedProof prove_speed(const std::vector<MotionLevel>& levels, const std::vector<HullBall>& hull, double c,
                       double last, double reach, const std::function<bool(double)>& is_enough,
                       double within) {
  const auto below = [](const Speeds& its) { return its.body < 1.0; };
  if (const Speeds all = speeds(levels, hull, c, within, -always, always); below(all))
    return {all.body, all.centre};
  SpeedProof proof;
  proof.begins = last;
  constexpr int most_pieces = 40'000;
  double length = reach / 64.0;
  for (int i = 0; i < most_pieces && (proof.begins > last - reach || !is_enough(proof.begins)); ++i) {
    const double from = proof.begins - length;
    const Speeds piece = speeds(levels, hull, c, within, from, proof.begins);
    if (below(piece)) {
      proof.speed = std::max(proof.speed, piece.body);
      proof.centre_speed = std::max(proof.centre_speed, piece.centre);
      proof.begins = from;
      length *= 1.5;
    } else {
      proof.speed_before = piece.body;
      length *= 0.5;
      if (!(length > (proof.begins > last - reach ? 1e-9 : 1e-4) * reach)) break;
    }
  }
  return proof;
}

}  // namespace backlight
