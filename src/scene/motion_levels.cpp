#include "motion_levels.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "backlight/expression/waves.h"
#include "backlight/surface/implicit.h"
#include "backlight/surface/placement.h"
#include "backlight/surface/wave_path.h"
#include "own_time.h"
#include "turning.h"

namespace backlight {
namespace {

using GraphNode = Composer::Node;

MotionCoordinates variables_of(Composer& composer) {
  return {composer.variable(0), composer.variable(1), composer.variable(2), composer.variable(3)};
}

/// What is multiplied by 0 or 1 leaves no trace.
GraphNode times(Composer& composer, GraphNode factor, const std::optional<double>& constant,
                GraphNode value) {
  if (constant == 1.0) return value;
  if (constant == 0.0) return composer.constant(0.0);
  return composer.apply(Operation::multiply, factor, value);
}

struct Turn {
  GraphNode sine, cosine;
  std::optional<double> constant_sine, constant_cosine;
};

/// Of an angle in degrees; whole quarter turns are exact.
Turn turn_by(Composer& composer, const Expression& degrees, const MotionCoordinates& at) {
  if (const auto constant = degrees.constant()) {
    const Mat3 matrix = Placement(Vec3{0.0}, {0.0, 0.0, *constant}, Vec3{1.0}).rest_from_local();
    const double sine = matrix[0][1];
    const double cosine = matrix[0][0];
    return {composer.constant(sine), composer.constant(cosine), sine, cosine};
  }
  const GraphNode radians = composer.apply(Operation::multiply, composer.insert(degrees, at),
                                           composer.constant(std::numbers::pi / 180.0));
  return {composer.apply(Operation::sin, radians), composer.apply(Operation::cos, radians), {}, {}};
}

/// About `axis`: from the next one to the one after that; back if not `forward`.
void rotate(Composer& composer, int axis, const Expression& degrees, bool forward, MotionCoordinates& x) {
  const Turn turn = turn_by(composer, degrees, x);
  if (turn.constant_cosine == 1.0) return;
  GraphNode& a = x[static_cast<std::size_t>((axis + 1) % 3)];
  GraphNode& b = x[static_cast<std::size_t>((axis + 2) % 3)];
  const GraphNode a_cosine = times(composer, turn.cosine, turn.constant_cosine, a);
  const GraphNode a_sine = times(composer, turn.sine, turn.constant_sine, a);
  const GraphNode b_cosine = times(composer, turn.cosine, turn.constant_cosine, b);
  const GraphNode b_sine = times(composer, turn.sine, turn.constant_sine, b);
  a = composer.apply(forward ? Operation::subtract : Operation::add, a_cosine, b_sine);
  b = composer.apply(forward ? Operation::add : Operation::subtract, b_cosine, a_sine);
}

/// x·n as a node.
GraphNode along(Composer& composer, const Vec3& n, const MotionCoordinates& x) {
  GraphNode sum = composer.constant(0.0);
  for (int i = 0; i < 3; ++i) {
    if (n[i] == 0.0) continue;
    const GraphNode term = times(composer, composer.constant(n[i]), n[i], x[static_cast<std::size_t>(i)]);
    sum = composer.apply(Operation::add, sum, term);
  }
  return sum;
}

/// x + way n.
void move_along(Composer& composer, const Vec3& n, GraphNode way, MotionCoordinates& x) {
  for (int i = 0; i < 3; ++i) {
    if (n[i] == 0.0) continue;
    GraphNode& to = x[static_cast<std::size_t>(i)];
    to = composer.apply(Operation::add, to, times(composer, composer.constant(n[i]), n[i], way));
  }
}

/// Equation (27): ξ = X·n + 1/a becomes √(ξ² ± t²).
void fly(Composer& composer, const RocketFlight& rocket, bool forward, MotionCoordinates& x) {
  const GraphNode time = times(composer, composer.constant(rocket.c), rocket.c, x[ImplicitFormula::t]);
  const GraphNode offset = composer.constant(1.0 / rocket.acceleration);
  const GraphNode here = composer.apply(Operation::add, along(composer, rocket.along, x), offset);
  const GraphNode square = composer.apply(Operation::square, here);
  const GraphNode other = composer.apply(forward ? Operation::add : Operation::subtract, square,
                                         composer.apply(Operation::square, time));
  GraphNode there = composer.apply(Operation::sqrt, other);
  if (rocket.acceleration < 0.0) there = composer.apply(Operation::negate, there);
  move_along(composer, rocket.along, composer.apply(Operation::subtract, there, here), x);
}

}  // namespace

bool MotionLevel::moves() const {
  return rocket || !constants_of(position) || !constants_of(rotate) || !constants_of(scale);
}

std::array<Expression, 3> constant_formulas(const Vec3& values) {
  return {constant_formula(values.x), constant_formula(values.y), constant_formula(values.z)};
}

std::optional<Vec3> constants_of(const std::array<Expression, 3>& formulas) {
  Vec3 values{0.0};
  for (int i = 0; i < 3; ++i) {
    const auto constant = formulas[static_cast<std::size_t>(i)].constant();
    if (!constant) return std::nullopt;
    values[i] = *constant;
  }
  return values;
}

Expression formula_of_time(const ImageValues& values, const Node& written) {
  if (const auto* number = std::get_if<double>(&written.value)) return constant_formula(*number + 0.0);
  const Expression formula = in_own_time(values, std::get<Expression>(written.value));
  Composer composer(ImplicitFormula::variables);
  const std::array<GraphNode, 1> time{composer.variable(ImplicitFormula::t)};
  return composer.expression(composer.insert(formula, time), formula.text());
}

namespace {

MotionCoordinates into_all(Composer& composer, const std::vector<MotionLevel>& levels, MotionCoordinates x) {
  for (const MotionLevel& level : levels) x = into(composer, level, x);
  return x;
}

MotionCoordinates out_of_all(Composer& composer, const std::vector<MotionLevel>& levels,
                             MotionCoordinates x) {
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) x = out_of(composer, *level, x);
  return x;
}

/// Whether all that moves is a rotation about one axis that stays, always as fast.
bool turns_steadily(const MotionLevel& level) {
  if (level.rocket || !constants_of(level.position) || !constants_of(level.scale)) return false;
  const auto angles = WavePath::of(level.rotate, 1.0);
  if (!angles || !angles->is_straight()) return false;
  const Vec3 speeds = angles->velocity();
  return (speeds.x != 0.0) + (speeds.y != 0.0) + (speeds.z != 0.0) == 1;
}

/// Whether each point is as fast as ever at all times: what turns is only moved as a whole by the levels
/// outside.
bool keeps_speeds(const std::vector<MotionLevel>& levels) {
  const auto moving = std::ranges::find_if(levels, &MotionLevel::moves);
  if (moving == levels.end() || !turns_steadily(*moving)) return false;
  const auto scales_alike = [](const MotionLevel& level) {
    const auto scale = constants_of(level.scale);
    return std::abs(scale->x) == std::abs(scale->y) && std::abs(scale->x) == std::abs(scale->z);
  };
  return std::all_of(levels.begin(), moving, scales_alike) &&
         std::none_of(std::next(moving), levels.end(),
                      [](const MotionLevel& level) { return level.moves(); });
}

}  // namespace

MatterMotion::Body body_of(const std::vector<MotionLevel>& levels) {
  return body_within(levels, {});
}

MatterMotion::Body body_within(const std::vector<MotionLevel>& levels,
                               const std::vector<MotionLevel>& within) {
  Composer composer(ImplicitFormula::variables);
  const MotionCoordinates given = variables_of(composer);
  const MotionCoordinates place = into_all(composer, within, out_of_all(composer, levels, given));
  const MotionCoordinates point = into_all(composer, levels, out_of_all(composer, within, given));
  MatterMotion::Body body;
  for (std::size_t i = 0; i < 3; ++i) {
    body.place[i] = composer.expression(place[i], "place");
    body.point[i] = composer.expression(point[i], "body point");
  }
  body.steady = keeps_speeds(levels);
  body.period = period_of_rates(body.place, ImplicitFormula::t);
  return body;
}

BodyBox moving_box(const std::vector<MotionLevel>& levels, const std::array<Interval, 3>& sides,
                   std::shared_ptr<const LineProgram>& of_whole) {
  auto end = levels.end();
  while (!std::prev(end)->moves()) --end;
  const std::vector<MotionLevel> moving(levels.begin(), end);
  const Placement inner = *placement_at_rest({end, levels.end()});
  BodyBox box{moving.size() == 1 ? of_whole : nullptr, {}, {}, {}};
  if (!box.common) {
    Composer composer(ImplicitFormula::variables);
    const MotionCoordinates within = into_all(composer, moving, variables_of(composer));
    box.common = std::make_shared<const LineProgram>(composer.tape(std::span(within).first(3)));
    if (moving.size() == 1) of_whole = box.common;
  }
  Vec3 middle{0.0};
  for (std::size_t k = 0; k < 3; ++k) {
    const int axis = static_cast<int>(k);
    middle[axis] = 0.5 * sides[k].lower + 0.5 * sides[k].upper;
    box.half[k] = 0.5 * sides[k].upper - 0.5 * sides[k].lower;
    for (int i = 0; i < 3; ++i) box.axis[k][i] = inner.local_from_rest()[i][axis];
  }
  const Vec3 centre = inner.position() + inner.rest_from_local() * middle;
  for (int k = 0; k < 3; ++k) box.centre[k] = centre[k];
  return box;
}

Expression moved_formula(const Expression& f, const std::vector<MotionLevel>& levels) {
  Composer composer(ImplicitFormula::variables);
  const MotionCoordinates x = into_all(composer, levels, variables_of(composer));
  return composer.expression(composer.insert(f, x), f.text() + ", in motion");
}

MotionCoordinates into(Composer& composer, const MotionLevel& level, MotionCoordinates x) {
  const MotionCoordinates outer = x;
  for (std::size_t i = 0; i < 3; ++i) {
    if (level.position[i].constant() == 0.0) continue;
    x[i] = composer.apply(Operation::subtract, x[i], composer.insert(level.position[i], outer));
  }
  if (level.rocket) fly(composer, *level.rocket, false, x);
  for (int axis = 2; axis >= 0; --axis)
    rotate(composer, axis, level.rotate[static_cast<std::size_t>(axis)], false, x);
  for (std::size_t i = 0; i < 3; ++i) {
    if (level.scale[i].constant() == 1.0) continue;
    x[i] = composer.apply(Operation::divide, x[i], composer.insert(level.scale[i], outer));
  }
  return x;
}

MotionCoordinates out_of(Composer& composer, const MotionLevel& level, MotionCoordinates x) {
  const MotionCoordinates inner = x;
  for (std::size_t i = 0; i < 3; ++i) {
    const GraphNode factor = composer.insert(level.scale[i], inner);
    x[i] = times(composer, factor, level.scale[i].constant(), x[i]);
  }
  for (int axis = 0; axis < 3; ++axis)
    rotate(composer, axis, level.rotate[static_cast<std::size_t>(axis)], true, x);
  if (level.rocket) fly(composer, *level.rocket, true, x);
  for (std::size_t i = 0; i < 3; ++i) {
    if (level.position[i].constant() == 0.0) continue;
    x[i] = composer.apply(Operation::add, x[i], composer.insert(level.position[i], inner));
  }
  return x;
}

}  // namespace backlight
