#include "compile_formulas.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "backlight/expression/compose.h"
#include "backlight/expression/enclosure.h"
#include "backlight/surface/matter_motion.h"
#include "motion_levels.h"
#include "own_time.h"
#include "speed_proof.h"

namespace backlight {
namespace {

using GraphNode = Composer::Node;
using Coordinates = std::array<GraphNode, 4>;  // x, y, z, t

// local_from_rest (X - position), row by row; what is zero or one leaves no trace in the formula.
Coordinates within(Composer& composer, const Coordinates& outer, const Placement& placement) {
  Coordinates inner = outer;
  Coordinates offset = outer;
  for (std::size_t j = 0; j < 3; ++j) {
    const double position = placement.position()[static_cast<int>(j)];
    if (position != 0.0) {
      offset[j] = composer.apply(Operation::subtract, outer[j], composer.constant(position));
    }
  }
  for (int i = 0; i < 3; ++i) {
    std::optional<GraphNode> sum;
    for (int j = 0; j < 3; ++j) {
      const double factor = placement.local_from_rest()[j][i];
      if (factor == 0.0) continue;
      GraphNode term = offset[static_cast<std::size_t>(j)];
      if (factor != 1.0) term = composer.apply(Operation::multiply, composer.constant(factor), term);
      sum = sum ? composer.apply(Operation::add, *sum, term) : term;
    }
    inner[static_cast<std::size_t>(i)] = sum.value_or(composer.constant(0.0));
  }
  return inner;
}

// min(a, b) - k/4 (1 - min(|a - b|/k, 1))².
GraphNode smooth_minimum(Composer& composer, GraphNode a, GraphNode b, double k) {
  const GraphNode apart = composer.apply(Operation::abs, composer.apply(Operation::subtract, a, b));
  const GraphNode one = composer.constant(1.0);
  const GraphNode part =
      composer.apply(Operation::min, composer.apply(Operation::divide, apart, composer.constant(k)), one);
  const GraphNode dent =
      composer.apply(Operation::multiply, composer.constant(0.25 * k),
                     composer.apply(Operation::square, composer.apply(Operation::subtract, one, part)));
  return composer.apply(Operation::subtract, composer.apply(Operation::min, a, b), dent);
}

UnresolvedRoots read_unresolved(const TableView& table) {
  return table.text("unresolved") == "skip" ? UnresolvedRoots::skip : UnresolvedRoots::take;
}

// The boxes of all parts, in the coordinates of the whole; nothing unless all are written.
std::optional<FormulaBounds> together(const std::vector<BlendPart>& parts) {
  FormulaBounds whole;
  whole.low = Vec3{std::numeric_limits<double>::infinity()};
  whole.high = -whole.low;
  for (const BlendPart& part : parts) {
    if (!part.bounds) return std::nullopt;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 local{(corner & 1) != 0 ? part.bounds->high.x : part.bounds->low.x,
                       (corner & 2) != 0 ? part.bounds->high.y : part.bounds->low.y,
                       (corner & 4) != 0 ? part.bounds->high.z : part.bounds->low.z};
      const Vec3 there = part.placement.position() + part.placement.rest_from_local() * local;
      whole.low = glm::min(whole.low, there);
      whole.high = glm::max(whole.high, there);
    }
  }
  return whole;
}

std::string number_list(const Vec3& v) {
  return "[" + number_text(v.x) + ", " + number_text(v.y) + ", " + number_text(v.z) + "]";
}

// Whether the formula makes a surface at all within its bounds.
bool makes_sense(const TableView& table, std::string_view key, const ImplicitFormula& formula,
                 const FormulaBounds& bounds) {
  const double everything = std::numeric_limits<double>::infinity();
  const Interval value =
      formula.range(bounds.low, bounds.high, {-everything, everything, Continuity::continuous});
  if (value.continuity == Continuity::undefined) {
    table.error(key, "the formula is defined nowhere within its bounds");
    return false;
  }
  if (value.lower == 0.0 && value.upper == 0.0) {
    table.error(key, "the formula is 0 everywhere within its bounds: that is no surface");
    return false;
  }
  return true;
}

// Of x, y, z and the matter's own t.
Expression bound(Compilation& c, const Node& written) {
  if (const auto* number = std::get_if<double>(&written.value)) return constant_formula(*number);
  return in_own_time(c.values, std::get<Expression>(written.value));
}

constexpr int deepest = 18;

// |v| < c at all points of the bounds where the surface may be, whenever: by intervals over pieces of the
// box.
bool is_slower(const MatterMotion::Map& velocity, double c, const ImplicitFormula& f, const Vec3& low,
               const Vec3& high, int depth) {
  const Interval time{-always, always, Continuity::continuous};
  const Interval value = f.range(low, high, time);
  if (value.lower > 0.0 || value.upper < 0.0) return true;
  const std::array<Interval, 4> box{Interval{low.x, high.x, Continuity::continuous},
                                    Interval{low.y, high.y, Continuity::continuous},
                                    Interval{low.z, high.z, Continuity::continuous}, time};
  double square = 0.0;
  for (const Expression& component : velocity) {
    const Interval range = enclose(component.tape(), box);
    const double size = std::max(std::abs(range.lower), std::abs(range.upper));
    square +=
        range.continuity == Continuity::continuous ? size * size : std::numeric_limits<double>::infinity();
  }
  if (square < c * c) return true;
  if (depth == 0) return false;
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (high[i] - low[i] > high[axis] - low[axis]) axis = i;
  }
  const double middle = 0.5 * low[axis] + 0.5 * high[axis];
  Vec3 below = high, above = low;
  below[axis] = above[axis] = middle;
  return is_slower(velocity, c, f, low, below, depth - 1) &&
         is_slower(velocity, c, f, above, high, depth - 1);
}

std::shared_ptr<const MatterMotion> given_motion(Compilation& c, const TableView& table,
                                                 const ImplicitFormula& f, const FormulaBounds& bounds) {
  if (!table.is_sound("matter_velocity")) return {};
  const NodeArray& written = *table.node_of("matter_velocity")->array();
  const MatterMotion::Map velocity{bound(c, written[0]), bound(c, written[1]), bound(c, written[2])};
  if (!is_slower(velocity, c.scene.c, f, bounds.low, bounds.high, deepest)) {
    table.error("matter_velocity",
                "matter on the surface cannot be shown to be slower than light, c = " +
                    number_text(c.scene.c) + ", within the bounds",
                "tighter bounds help where it is only fast far away");
    return {};
  }
  return std::make_shared<const MatterMotion>(velocity, clock_of(c));
}

void warn_of_still_matter(const TableView& table, std::string_view key) {
  table.warning(key,
                "the surface depends on t, and its colours are those of matter at rest, through which it "
                "passes like a wave",
                "matter_velocity = [vx, vy, vz] says how the matter moves; position, rotate and scale "
                "that depend on t move a body");
}

std::optional<Shape> finished(Compilation& c, const TableView& table, std::string_view key,
                              const std::shared_ptr<const ImplicitFormula>& formula,
                              const std::optional<FormulaBounds>& bounds,
                              const std::shared_ptr<const ImplicitBlend>& blend = {}) {
  if (!bounds) {
    table.error(key, "this surface has no bounds, or they cannot be proved",
                "write the two corners of a box to show it in: bounds = [[-2, -2, -2], [2, 2, 2]]");
    return std::nullopt;
  }
  ImplicitOptions options{read_unresolved(table), 1.0 / c.scene.c, blend, {}, RootFinder::interval};
  if (const std::string wrong = problem(implicit(formula, bounds->low, bounds->high, options));
      !wrong.empty()) {
    table.error("bounds", wrong,
                "they are " + number_list(bounds->low) + " and " + number_list(bounds->high));
    return std::nullopt;
  }
  if (!makes_sense(table, key, *formula, *bounds)) return std::nullopt;
  options.finder = c.cache.root_finder(*formula, *bounds);
  if (table.node_of("matter_velocity") != nullptr) {
    options.motion = given_motion(c, table, *formula, *bounds);
    if (!options.motion) return std::nullopt;
  } else if (formula->uses_time()) {
    warn_of_still_matter(table, key);
  }
  return implicit(formula, bounds->low, bounds->high, options);
}

}  // namespace

double speed_of_flow(const Shape& shape, double c) {
  const MatterMotion::Map* flow = shape.motion ? shape.motion->flow() : nullptr;
  if (flow == nullptr) return 0.0;
  const auto& v = shape.values;
  constexpr int steps = 64;
  for (int i = 1; i < steps; ++i) {
    const double speed = i * c / steps;
    if (is_slower(*flow, speed, *shape.formula, {v[0], v[1], v[2]}, {v[3], v[4], v[5]}, deepest))
      return speed;
  }
  return c;
}

std::optional<FormulaBounds> written_bounds(const TableView& table) {
  if (!table.has_valid("bounds") || !table.is_sound("bounds")) return std::nullopt;
  const std::size_t errors = table.values().diagnostics.error_count();
  FormulaBounds bounds;
  bounds.low = table.vector_at("bounds", 0);
  bounds.high = table.vector_at("bounds", 1);
  if (table.values().diagnostics.error_count() > errors) return std::nullopt;
  return bounds;
}

std::optional<Expression> bound_formula(Compilation& c, const TableView& table) {
  const Node* written = table.node_of("f");
  const auto* formula = written != nullptr ? std::get_if<Expression>(&written->value) : nullptr;
  if (formula == nullptr) return std::nullopt;
  Expression bound = in_own_time(c.values, *formula);
  for (std::size_t i = 0; i < formula_coordinates; ++i) {
    if (bound.uses(i)) return bound;
  }
  table.error("f", "the formula does not depend on x, y or z: that is no surface");
  return std::nullopt;
}

std::optional<Shape> compile_implicit(Compilation& c, const TableView& table) {
  const auto formula = bound_formula(c, table);
  if (!formula) return std::nullopt;
  const auto surface = std::make_shared<const ImplicitFormula>(*formula);
  if (table.has("bounds")) {
    const auto bounds = written_bounds(table);
    return bounds ? finished(c, table, "f", surface, bounds) : std::nullopt;
  }
  const auto bounds = c.cache.bounds(*surface);
  return finished(c, table, "f", surface, bounds);
}

namespace {

/// The signed distance from faces that meet at right angles, of which a point is `first` outside the one it
/// is farthest from, and `second` and `third` outside the others: √(max(first,0)² + max(second,0)² +
/// max(third,0)²) outside, `first` inside. Written as `first` and what is added near an edge, which next to a
/// face is 0 with slope 0, so that intervals find f to be monotone there.
std::string corner_distance(const std::string& first, const std::string& second, const std::string& third) {
  const std::string aside = "(max(" + second + ", 0)^2 + max(" + third + ", 0)^2)";
  const std::string outside = "max(" + first + ", 0)";
  return first + " + " + aside + "/(sqrt(max(" + outside + "^2 + " + aside + ", 1e-200)) + " + outside + ")";
}

}  // namespace

Expression formula_of_text(const std::string& text, const std::vector<std::string>& names,
                           const std::vector<double>& values) {
  std::vector<std::string> variables{"x", "y", "z", "t"};
  variables.insert(variables.end(), names.begin(), names.end());
  return std::get<Expression>(Expression::parse(text, variables)).bind(ImplicitFormula::variables, values);
}

std::optional<Expression> formula_of(const Shape& shape) {
  const auto& v = shape.values;
  switch (shape.kind) {
    case ShapeKind::sphere:
      return formula_of_text("sqrt(x^2 + y^2 + z^2) - radius", {"radius"}, {v[0]});
    case ShapeKind::torus:
      return formula_of_text("sqrt((sqrt(x^2 + z^2) - major)^2 + y^2) - minor", {"major", "minor"},
                             {v[0], v[1]});
    case ShapeKind::plane:
      return formula_of_text("y", {}, {});
    case ShapeKind::box:
      return formula_of_text(
          corner_distance("max(abs(x) - a, abs(y) - b, abs(z) - c)",
                          "max(min(abs(x) - a, abs(y) - b), min(max(abs(x) - a, abs(y) - b), abs(z) - c))",
                          "min(abs(x) - a, abs(y) - b, abs(z) - c)"),
          {"a", "b", "c"}, {0.5 * v[0], 0.5 * v[1], 0.5 * v[2]});
    case ShapeKind::cylinder:
      return formula_of_text(corner_distance("max(sqrt(x^2 + z^2) - r, abs(y) - h)",
                                             "min(sqrt(x^2 + z^2) - r, abs(y) - h)", "-1"),
                             {"r", "h"}, {v[0], 0.5 * v[1]});
    case ShapeKind::quadric:
      return formula_of_text("c0*x^2 + c1*y^2 + c2*z^2 + c3*x*y + c4*x*z + c5*y*z + c6*x + c7*y + c8*z + c9",
                             {"c0", "c1", "c2", "c3", "c4", "c5", "c6", "c7", "c8", "c9"},
                             {v.begin(), v.end()});
    case ShapeKind::cone:
    case ShapeKind::disk:
    case ShapeKind::csg:
    case ShapeKind::implicit:
    case ShapeKind::mesh:
    case ShapeKind::travelling_ball:
      break;
  }
  return std::nullopt;
}

Expression blended(const std::vector<BlendPart>& parts, double blend) {
  Composer composer(ImplicitFormula::variables);
  const Coordinates outer{composer.variable(0), composer.variable(1), composer.variable(2),
                          composer.variable(3)};
  std::optional<Composer::Node> whole;
  std::string text;
  for (const BlendPart& part : parts) {
    const Composer::Node one = composer.insert(part.formula, within(composer, outer, part.placement));
    whole = whole ? smooth_minimum(composer, *whole, one, blend) : one;
    text += (text.empty() ? "blend of " : ", ") + part.formula.text();
  }
  return composer.expression(*whole, text);
}

std::optional<Shape> compile_blend(Compilation& c, const TableView& table,
                                   const std::vector<BlendPart>& parts) {
  const Expression formula = blended(parts, table.number("blend"));
  const auto surface = std::make_shared<const ImplicitFormula>(formula);
  auto origins = std::make_shared<ImplicitBlend>();
  for (const BlendPart& part : parts) {
    origins->formulas.emplace_back(blended({part}, 1.0));
    origins->members.push_back(part.member);
  }
  std::optional<FormulaBounds> bounds;
  if (table.has("bounds")) {
    bounds = written_bounds(table);
    if (!bounds) return std::nullopt;
  } else {
    bounds = c.cache.bounds(*surface);
    if (!bounds) bounds = together(parts);
  }
  return finished(c, table, "shape", surface, bounds, origins);
}

}  // namespace backlight
