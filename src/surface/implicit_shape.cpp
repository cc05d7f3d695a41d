// The implicit surface f = 0 inside its bounds, as a shape.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "backlight/surface/implicit_surface.h"
#include "convex.h"
#include "implicit_points.h"
#include "implicit_roots.h"
#include "shape_table.h"
#include "solid_walk.h"

namespace backlight {
namespace {

using implicit_value::skips;
using implicit_value::time_scale;

constexpr int caps = implicit_caps;

Vec3 low_of(const Shape& shape) {
  return implicit_low(shape);
}
Vec3 high_of(const Shape& shape) {
  return implicit_high(shape);
}

std::string problem_of(const Shape& shape) {
  if (!shape.formula) return "a formula is missing";
  if (shape.formula->expression().constant()) return "the formula is a constant: it makes no surface";
  for (int i = 0; i < 3; ++i) {
    const double low = low_of(shape)[i];
    const double high = high_of(shape)[i];
    if (!(std::isfinite(low) && std::isfinite(high) && low < high)) {
      return "bounds must be finite, and the low corner below the high one";
    }
  }
  return {};
}

double radius_of(const Shape& shape, const Vec3& factor) {
  return glm::length(glm::max(glm::abs(low_of(shape)), glm::abs(high_of(shape))) * factor);
}

double extent_of(const Shape& shape, const Extent& e) {
  const Vec3 reach = glm::max(glm::abs(low_of(shape)), glm::abs(high_of(shape)));
  return reach.x * e.x + reach.y * e.y + reach.z * e.z;
}

Stretch inside_bounds(const Shape& shape, const LocalLine& line) {
  const Vec3 centre = 0.5 * low_of(shape) + 0.5 * high_of(shape);
  const Vec3 half = 0.5 * high_of(shape) - 0.5 * low_of(shape);
  Stretch stretch;
  for (int i = 0; i < 3; ++i) {
    narrow_to_slab(stretch, line.point[i] - centre[i], line.direction[i], half[i], 2 * i + caps);
  }
  return stretch;
}

FormulaLine formula_line(const Shape& shape, const LocalLine& line) {
  const Vec3& p = line.point;
  const Vec3& d = line.direction;
  const double scale = shape.values[time_scale];
  return {{p.x, p.y, p.z, scale * line.clock.start}, {d.x, d.y, d.z, scale * line.clock.rate}};
}

/// For the statistics.
thread_local std::uint64_t roots_solved = 0;

/// Whether a root is left out.
bool skipped(const Shape& shape, const Root& root) {
  return root.kind == RootKind::unresolved && shape.values[skips] != 0.0;
}

RootFinder finder_of(const Shape& shape) {
  return static_cast<RootFinder>(shape.values[implicit_value::finder]);
}

Crossing crossing_of(const Root& root) {
  return {root.t, 0, root.kind == RootKind::unresolved};
}

/// What the search for the first roots is given, and where each answer belongs.
struct Questions {
  std::vector<LinePiece> pieces;
  std::vector<std::size_t> line_of;
  std::vector<Root> roots;
};

Questions& questions_of_thread() {
  thread_local Questions questions;
  questions.pieces.clear();
  questions.line_of.clear();
  return questions;
}

/// The roots on a line from `from` on, one after the other, as far as they are wanted.
Crossings walk_along(const Shape& shape, const LocalLine& line, double from, double to, double lambda_min,
                     Wanted wanted) {
  Crossings result;
  RootWalk walk(*shape.formula, formula_line(shape, line), from, to);
  for (Root root; result.count < 4 && walk.next(root);) {
    ++roots_solved;
    if (skipped(shape, root) || (wanted == Wanted::first && !(line.lambda(root.t) > lambda_min))) continue;
    result.list[result.count++] = crossing_of(root);
    if (wanted == Wanted::first) break;
  }
  return result;
}

void first_crossings_of(const Shape& shape, std::span<const LocalLine> lines, double lambda_min,
                        std::span<Crossings> results) {
  Questions& q = questions_of_thread();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const LocalLine& line = lines[i];
    results[i] = {};
    const Stretch stretch = inside_bounds(shape, line);
    const double start = (lambda_min - line.lambda_centre - line.lambda_shift) / line.lambda_per_length;
    const double from = std::max(stretch.in, start);
    if (!(from <= stretch.out)) continue;
    q.pieces.push_back({formula_line(shape, line), from, stretch.out});
    q.line_of.push_back(i);
  }
  q.roots.resize(q.pieces.size());
  first_roots(*shape.formula, q.pieces, q.roots, finder_of(shape));
  for (std::size_t k = 0; k < q.pieces.size(); ++k) {
    if (!found(q.roots[k])) continue;
    ++roots_solved;
    const LocalLine& line = lines[q.line_of[k]];
    Crossings& result = results[q.line_of[k]];
    if (!skipped(shape, q.roots[k]) && line.lambda(q.roots[k].t) > lambda_min) {
      result.list[result.count++] = crossing_of(q.roots[k]);
    } else {
      result = walk_along(shape, line, q.pieces[k].from, q.pieces[k].to, lambda_min, Wanted::first);
    }
  }
}

Crossings crossings_of(const Shape& shape, const LocalLine& line, double lambda_min, Wanted wanted) {
  if (wanted == Wanted::first) {
    Crossings result;
    first_crossings_of(shape, {&line, 1}, lambda_min, {&result, 1});
    return result;
  }
  const Stretch stretch = inside_bounds(shape, line);
  if (!(stretch.in <= stretch.out)) return {};
  return walk_along(shape, line, stretch.in, stretch.out, lambda_min, wanted);
}

void begin_walk(const Shape& shape, const LocalLine& line, double from, SolidWalk& walk) {
  walk.begin(*shape.formula, formula_line(shape, line), inside_bounds(shape, line), from,
             shape.values[skips] == 0.0);
}

LocalPoint point_of(const Shape& shape, const LocalLine& line, const Crossing& crossing) {
  LocalPoint point;
  implicit_points(shape, {&line, 1}, {&crossing, 1}, TextureCoordinates::wanted, {&point, 1});
  return point;
}

}  // namespace

const ShapeMethods implicit_methods{ShapeKind::implicit, "implicit",         true,         problem_of,
                                    radius_of,           extent_of,          crossings_of, point_of,
                                    begin_walk,          first_crossings_of, finder_of,    implicit_points};

std::uint64_t roots_solved_by_this_thread() {
  return roots_solved;
}

void count_root_solved() {
  ++roots_solved;
}

Shape implicit(std::shared_ptr<const ImplicitFormula> f, Vec3 low, Vec3 high) {
  return implicit(std::move(f), low, high, ImplicitOptions{});
}

Shape implicit(std::shared_ptr<const ImplicitFormula> f, Vec3 low, Vec3 high,
               const ImplicitOptions& options) {
  Shape shape{ShapeKind::implicit, {low.x, low.y, low.z, high.x, high.y, high.z}, {}, {}, {}};
  shape.values[time_scale] = options.seconds_per_length;
  shape.values[skips] = options.unresolved == UnresolvedRoots::skip ? 1.0 : 0.0;
  shape.formula = std::move(f);
  shape.blend = options.blend;
  if (!problem_of(shape).empty()) return shape;
  const RootFinder finder = options.finder ? *options.finder : choose_root_finder(*shape.formula, low, high);
  shape.values[implicit_value::finder] = static_cast<double>(finder);
  return shape;
}

}  // namespace backlight
