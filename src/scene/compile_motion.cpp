#include "compile_motion.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "backlight/expression/enclosure.h"
#include "backlight/surface/implicit_surface.h"
#include "backlight/surface/mesh.h"
#include "backlight/surface/wave_path.h"
#include "body_formula.h"
#include "camera_motion.h"
#include "compile_formulas.h"
#include "compile_shapes.h"
#include "motion_levels.h"
#include "speed_proof.h"
#include "turning.h"
#include "words.h"

namespace backlight {
namespace {

bool place_uses_time(const Description& description, const Node& table);

bool parts_use_time(const Description& description, const Node& table) {
  const Entry* parts = find(table, "part");
  if (parts == nullptr || parts->node.array() == nullptr) return false;
  return std::ranges::any_of(*parts->node.array(),
                             [&](const Node& part) { return place_uses_time(description, part); });
}

bool place_uses_time(const Description& description, const Node& table) {
  for (const std::string_view key : {"position", "rotate", "scale"}) {
    const Entry* entry = find(table, key);
    if (entry != nullptr && uses_time(description, entry->node)) return true;
  }
  return parts_use_time(description, table);
}

bool parts_flow(const Node& table) {
  const Entry* parts = find(table, "part");
  if (parts == nullptr || parts->node.array() == nullptr) return false;
  return std::ranges::any_of(*parts->node.array(), [](const Node& part) {
    return find(part, "matter_velocity") != nullptr || parts_flow(part);
  });
}

/// Matter that flows together has no velocity of its parts: whether a table's blends are at rest in
/// themselves.
bool blends_move_as_a_whole(Compilation& c, const TableView& table) {
  if (table.node_of("part") == nullptr || table.node_of("part")->array() == nullptr) return true;
  bool good = true;
  for (const Node& node : *table.node_of("part")->array()) {
    const TableView part(c.values, &node, *find_table("object.part"));
    good = blends_move_as_a_whole(c, part) && good;
    if (!table.has_valid("blend")) continue;
    for (const std::string_view key : {"position", "rotate", "scale"}) {
      const Entry* entry = find(node, key);
      if (entry == nullptr || !uses_time(c.values.description, entry->node)) continue;
      part.error(key,
                 "the parts of a blend cannot move against each other: where they flow together, the matter "
                 "is no one's",
                 "the whole can move; image_time instead of t puts a part somewhere else for each image");
      good = false;
    }
  }
  return good;
}

/// About the body's origin.
MatterMotion::Ball ball_of(const MatterMotion::Body& body, const SpeedProof& proof, double radius, double c) {
  MatterMotion::Ball ball{{}, radius, proof.centre_speed, proof.begins * c};
  Composer composer(ImplicitFormula::variables);
  const Composer::Node zero = composer.constant(0.0);
  const std::array<Composer::Node, 4> origin{zero, zero, zero, composer.variable(ImplicitFormula::t)};
  for (std::size_t i = 0; i < 3; ++i) {
    ball.path[i] = composer.expression(composer.insert(body.place[i], origin), "");
  }
  return ball;
}

/// A box about a hull.
std::array<Interval, 3> box_of(const std::vector<HullBall>& hull) {
  Vec3 low{std::numeric_limits<double>::infinity()};
  Vec3 high = -low;
  for (const HullBall& ball : hull) {
    low = glm::min(low, ball.centre - ball.radius);
    high = glm::max(high, ball.centre + ball.radius);
  }
  return {Interval{low.x, high.x, Continuity::continuous}, Interval{low.y, high.y, Continuity::continuous},
          Interval{low.z, high.z, Continuity::continuous}};
}

/// Whether anything that matter has by its own time depends on it: a material, its presence, the light around
/// it.
bool lives_by_own_time(const Description& description, const Node& node, bool of_matter) {
  if (of_matter && uses_time(description, node)) return true;
  if (const NodeArray* array = node.array()) {
    return std::ranges::any_of(
        *array, [&](const Node& one) { return lives_by_own_time(description, one, of_matter); });
  }
  const NodeTable* table = node.table();
  return table != nullptr && std::ranges::any_of(*table, [&](const Entry& entry) {
           const bool matters =
               entry.name == "material" || entry.name == "visible" || entry.name == "radiance";
           return lives_by_own_time(description, entry.node, of_matter || matters);
         });
}

/// The middle of where formulas of t ever are, which is taken off them: of what goes on forever, however
/// slowly, nothing, since the middle is far from where it is seen and would cost the digits of its places.
Vec3 take_middle(std::array<Expression, 3>& formulas) {
  Vec3 middle{0.0};
  for (int i = 0; i < 3; ++i) {
    Expression& formula = formulas[static_cast<std::size_t>(i)];
    constexpr double not_long = 0x1p-20 * always;
    const Interval range = over_times(formula, -always, always).value,
                   part = over_times(formula, -not_long, not_long).value;
    const double width = range.upper - range.lower;
    if (!std::isfinite(width) || width > 4.0 * (part.upper - part.lower)) continue;
    middle[i] = 0.5 * range.lower + 0.5 * range.upper;
    Composer composer(ImplicitFormula::variables);
    const std::array<Composer::Node, 4> at{composer.variable(0), composer.variable(1), composer.variable(2),
                                           composer.variable(3)};
    const Composer::Node off =
        composer.apply(Operation::subtract, composer.insert(formula, at), composer.constant(middle[i]));
    formula = composer.expression(off, formula.text());
  }
  return middle;
}

/// Of a ball that stays one while it goes along a path of waves, turning or not.
std::optional<double> radius_of_ball(const Shape& shape, const std::vector<MotionLevel>& levels) {
  if (shape.kind != ShapeKind::sphere || levels.size() != 1) return std::nullopt;
  const MotionLevel& level = levels.front();
  const auto scale = constants_of(level.scale);
  const bool round =
      scale && std::abs(scale->x) == std::abs(scale->y) && std::abs(scale->x) == std::abs(scale->z);
  const bool travels = !level.rocket && !constants_of(level.position) && WavePath::of(level.position, 1.0);
  return round && travels ? std::optional(shape.values[0] * std::abs(scale->x)) : std::nullopt;
}

class MotionCompiler {
 public:
  MotionCompiler(Compilation& c, const TableView& object, int frame)
      : c_(c), object_(object), prover_(c, frame) {}

  std::optional<MovingShape> put_in_motion(const Shape& shape, const SolidTree* solid, const Vec3& offset) {
    if (!blends_move_as_a_whole(c_, object_)) return std::nullopt;
    MotionLevel whole = level_of(object_);
    if (has_motion(object_)) whole.position = constant_formulas(Vec3{0.0});
    const std::size_t errors = c_.values.diagnostics.error_count();
    take_rocket(object_, c_.scene.c, whole);
    if (c_.values.diagnostics.error_count() > errors) return std::nullopt;
    MovingShape moving;
    moving.placement = Placement(take_middle(whole.position), Vec3{0.0}, Vec3{1.0});
    offset_ = offset + moving.placement.position();
    if (auto carried = carry(shape, whole, moving.placement.position())) return carried;
    SolidTree tree;
    if (solid != nullptr) {
      tree = *solid;
    } else {
      tree.shape = shape;
    }
    if (!put_parts_in_motion(object_, tree, {whole}, solid != nullptr)) return std::nullopt;
    if (solid != nullptr) {
      moving.shape = csg(tree);
    } else {
      moving.shape = tree.shape;
      moving.placement = moving.placement.around(tree.placement);
    }
    moving.shape.presence = shape.presence;
    moving.proved_anywhere = proved_anywhere_;
    return moving;
  }

 private:
  /// What goes straight on as a whole keeps its own form.
  [[nodiscard]] std::optional<MovingShape> carry(const Shape& shape, const MotionLevel& whole,
                                                 const Vec3& middle) const {
    const auto rotate = constants_of(whole.rotate), scale = constants_of(whole.scale);
    const bool is_whole = rotate && scale && !whole.rocket && !shape.motion && !is_infinite(shape);
    const Node& table = *object_.node();
    if (!is_whole || parts_use_time(c_.values.description, table) || parts_flow(table)) return std::nullopt;
    const auto path = WavePath::of(whole.position, 1.0 / c_.scene.c);
    if (!path || !path->is_straight() || path->is_still() || !(path->most_speed() < 1.0)) return std::nullopt;
    const Placement turned(Vec3{0.0}, *rotate, *scale);
    const Vec3 centre = shape.mesh ? turned.rest_from_local() * shape.mesh->centre() : Vec3{0.0};
    MovingShape moving{shape, Placement(middle + path->start() + centre, *rotate, *scale)};
    SurfaceSet one;
    one.add(shape, turned);
    moving.shape.motion =
        std::make_shared<const MatterMotion>(path->velocity(), one.bounds(0).radius, clock_of(c_));
    return moving;
  }

  bool put_parts_in_motion(const TableView& table, SolidTree& tree, const std::vector<MotionLevel>& levels,
                           bool closed) {
    tree.placement = Placement{};
    if (tree.parts.empty()) return put_leaf_in_motion(table, tree, levels, closed);
    const NodeArray& written = *table.node_of("part")->array();
    bool good = true;
    for (std::size_t i = 0; i < tree.parts.size(); ++i) {
      const TableView part(c_.values, &written[i], *find_table("object.part"));
      std::vector<MotionLevel> inner = levels;
      inner.push_back(level_of(part));
      good = put_parts_in_motion(part, tree.parts[i], inner, closed) && good;
    }
    return good;
  }

  /// What stays where it is keeps its own form: what does not move, and a surface of revolution that turns
  /// about its own axis.
  bool put_leaf_in_motion(const TableView& table, SolidTree& leaf, const std::vector<MotionLevel>& levels,
                          bool closed) {
    const bool moves = std::ranges::any_of(levels, &MotionLevel::moves);
    const auto rest =
        moves && !turns_in_itself(leaf.shape, levels) ? std::nullopt : placement_at_rest(levels);
    if (!rest) {
      auto moved = leaf_in_motion(table, leaf.shape, levels, closed);
      if (moved) leaf.shape = *std::move(moved);
      return moved.has_value();
    }
    leaf.placement = *rest;
    if (!moves) return true;
    const auto proof = prover_.prove(table, levels, hull_of(leaf.shape), offset_);
    if (!proof) return false;
    proved_anywhere_ = proved_anywhere_ && std::isinf(proof->begins);
    leaf.shape.motion = std::make_shared<const MatterMotion>(body_within(levels, at_rest(levels)), leaf.shape,
                                                             std::nullopt, clock_of(c_));
    return true;
  }

  std::optional<Shape> leaf_in_motion(const TableView& table, const Shape& shape,
                                      const std::vector<MotionLevel>& levels, bool closed) {
    const auto ball_radius = closed ? std::nullopt : radius_of_ball(shape, levels);
    auto formula = ball_radius ? std::nullopt : body_formula(c_, table, shape, closed);
    if (!formula && !ball_radius) return std::nullopt;
    SurfaceSet one;
    one.add(shape, Placement{});
    const TableView& in_motion = place_uses_time(c_.values.description, *table.node()) ? table : object_;
    const std::vector<HullBall> hull = hull_of(shape);
    const auto proof = prover_.prove(in_motion, levels, hull, offset_, speed_of_flow(shape, c_.scene.c));
    if (!proof) return std::nullopt;
    proved_anywhere_ = proved_anywhere_ && std::isinf(proof->begins);
    MatterMotion::Body body = body_of(levels);
    if (shape.motion && shape.motion->flow() != nullptr) body.flow = *shape.motion->flow();
    const std::array<Interval, 3> box = box_of(hull);
    body.box = moving_box(levels, box, whole_);
    const Interval times = times_of(*proof);
    const double radius = one.bounds(0).radius * stretch_of(levels, times.lower, times.upper);
    MatterMotion::Ball ball = ball_of(body, *proof, radius * (1.0 + 1e-12), c_.scene.c);
    // Whatever turns about it is no part of its path.
    if (levels.size() == 1 && !levels.front().rocket) ball.path = levels.front().position;
    if (ball_radius) {
      const bool turns = !constants_of(levels.front().rotate);
      return travelling_ball(*ball_radius, turns,
                             std::make_shared<const MatterMotion>(body, shape, ball, clock_of(c_)));
    }
    Vec3 low{0.0}, high{0.0};
    for (std::size_t i = 0; i < 3; ++i) {
      const int k = static_cast<int>(i);
      const Interval path = over_times(ball.path[i], times.lower, times.upper).value;
      // All places of a box about the body, and those of a ball about its centre.
      const Interval places = enclose(body.place[i].tape(), std::array{box[0], box[1], box[2], times});
      low[k] = std::max(path.lower - ball.radius, places.lower - 1e-12 * ball.radius);
      high[k] = std::min(path.upper + ball.radius, places.upper + 1e-12 * ball.radius);
    }
    // Errors of its points are told by the size of its bounds, which those of a thing that leaves are not.
    constexpr double many_radii = 1e6;
    const bool bounded = glm::length(high - low) < many_radii * ball.radius;
    if (!bounded) {
      low = Vec3{-std::numeric_limits<double>::infinity()};
      high = -low;
    }
    ImplicitOptions options;
    options.seconds_per_length = 1.0 / c_.scene.c;
    options.unresolved = unresolved_of(shape);
    const auto centre = WavePath::of(ball.path, 1.0);
    const bool rests = bounded && std::isinf(ball.begins) && centre && centre->is_still();
    options.motion = std::make_shared<const MatterMotion>(
        body, shape, rests ? std::nullopt : std::optional(ball), clock_of(c_));
    options.finder = RootFinder::affine;
    if (shape.blend) {
      auto blend = std::make_shared<ImplicitBlend>();
      for (const ImplicitFormula& part : shape.blend->formulas) {
        blend->formulas.emplace_back(moved_formula(part.expression(), levels));
      }
      blend->members = shape.blend->members;
      options.blend = blend;
    }
    const auto moved = std::make_shared<const ImplicitFormula>(moved_formula(*formula, levels));
    return implicit(moved, low, high, options);
  }

  /// For which it is proved.
  [[nodiscard]] Interval times_of(const SpeedProof& proof) const {
    if (std::isinf(proof.begins)) return {-always, always, Continuity::continuous};
    // Later than the last are lines of one moment.
    return {proof.begins, 2.0 * prover_.last() - proof.begins, Continuity::continuous};
  }

  Compilation& c_;
  const TableView& object_;
  SpeedProver prover_;
  Vec3 offset_{0.0};
  bool proved_anywhere_ = true;
  std::shared_ptr<const LineProgram> whole_;  ///< the coordinates that move with the whole
};

std::array<Expression, 3> formulas_of(const TableView& table, std::string_view key, const Vec3& now) {
  const Node* node = table.node_of(key);
  const bool sound = node != nullptr && table.is_sound(key);  // else it has been reported
  if (!sound || !uses_time(table.values().description, *node)) return constant_formulas(now);
  std::array<Expression, 3> formulas;
  for (std::size_t i = 0; i < 3; ++i) {
    const NodeArray* three = node->array();
    formulas[i] = formula_of_time(table.values(), three != nullptr ? (*three)[i] : *node);
  }
  return formulas;
}

}  // namespace

MotionLevel level_of(const TableView& table) {
  return {formulas_of(table, "position", table.vector("position")),
          formulas_of(table, "rotate", table.vector("rotate")),
          formulas_of(table, "scale", read_scale(table)), std::nullopt};
}

void take_rocket(const TableView& table, double c, MotionLevel& level) {
  if (!table.has_valid("rocket")) return;
  const TableView rocket = table.table("rocket", "rocket");
  const auto along = rocket.complete() ? thrust_direction(rocket) : std::nullopt;
  if (!along) return;
  level.rocket = {rocket.number("acceleration") / (c * c), along->rounded(), c};
  for (const char* key : {"position", "rotate", "scale"}) {
    const Entry* written = find(*table.node(), key);
    if (written != nullptr && uses_time(table.values().description, written->node)) {
      table.error(key,
                  std::string("what flies with a rocket cannot also move by a formula of t in '") + key + "'",
                  "a solid's parts can, within it");
    }
  }
}

MatterMotion::Time clock_of(const Compilation& c) {
  const auto& aovs = c.scene.film.aovs;
  const bool shown = std::ranges::find(aovs, "properTime") != aovs.end();
  const Description& description = c.values.description;
  std::optional<bool>& lives = c.parts.lives_by_own_time;
  if (!lives) lives = lives_by_own_time(description, description.root, false);
  return {1.0 / c.scene.c, shown || *lives};
}

void check_motions_apart(const TableView& thing, const ExtendedVec3& celerity) {
  if (celerity == ExtendedVec3{} || thing.node() == nullptr) return;
  for (const char* key : {"position", "rotate", "scale"}) {
    const Entry* written = find(*thing.node(), key);
    if (written == nullptr || !uses_time(thing.values().description, written->node)) continue;
    thing.error(
        key, std::string("a thing moves by a velocity or by formulas of t in '") + key + "', not by both",
        "define a [frame.NAME] with this velocity, and let it move in that; image_time instead of t puts it "
        "somewhere else for each image");
  }
}

bool is_in_motion(const TableView& thing) {
  if (thing.node() == nullptr) return false;
  return find(*thing.node(), "rocket") != nullptr ||
         (!has_motion(thing) && place_uses_time(thing.values().description, *thing.node()));
}

std::shared_ptr<const MatterMotion> path_of(Compilation& c, const TableView& light, int frame) {
  const std::size_t errors = c.values.diagnostics.error_count();
  MotionLevel level{formulas_of(light, "position", light.vector("position")), constant_formulas(Vec3{0.0}),
                    constant_formulas(Vec3{1.0}), std::nullopt};
  if (has_motion(light)) level.position = constant_formulas(Vec3{0.0});
  take_rocket(light, c.scene.c, level);
  if (c.values.diagnostics.error_count() > errors) return {};
  const SpeedProver prover(c, frame);
  const auto proof = prover.prove(light, {level}, {HullBall{}}, Vec3{0.0});
  if (!proof) return {};
  const MatterMotion::Body body = body_of({level});
  MatterMotion::Ball ball = ball_of(body, *proof, 0.0, c.scene.c);
  return std::make_shared<const MatterMotion>(body, sphere(1.0), ball, clock_of(c));
}

std::optional<MovingShape> put_in_motion(Compilation& c, const TableView& object, int frame,
                                         const Shape& shape, const SolidTree* solid, const Vec3& offset) {
  return MotionCompiler(c, object, frame).put_in_motion(shape, solid, offset);
}

}  // namespace backlight
