// The implicit surface f = 0 inside its bounds, as a shape.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "backlight/base/thread_memory.h"
#include "backlight/surface/implicit_surface.h"
#include "implicit_points.h"
#include "implicit_stretches.h"
#include "shape_table.h"
#include "solid_walk.h"

namespace backlight {
namespace {

using implicit_value::skips;
using implicit_value::time_scale;

Vec3 low_of(const Shape& shape) {
  return implicit_low(shape);
}
Vec3 high_of(const Shape& shape) {
  return implicit_high(shape);
}

std::string problem_of(const Shape& shape) {
  if (!shape.formula) return "a formula is missing";
  if (shape.formula->expression().constant()) return "the formula is a constant: it makes no surface";
  if (goes_away(shape)) return {};
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

/// For the statistics.
thread_local std::uint64_t roots_solved = 0;

RootFinder finder_of(const Shape& shape) {
  return static_cast<RootFinder>(shape.values[implicit_value::finder]);
}

/// What the search for the first roots is given, and where each answer belongs.
struct Questions {
  std::vector<LinePiece> pieces;
  std::vector<std::size_t> line_of;
  std::vector<Root> roots;
};

Questions& questions_of_thread() {
  static constinit thread_local ThreadMemory<Questions> memory;
  Questions& questions = memory.get();
  questions.pieces.clear();
  questions.line_of.clear();
  return questions;
}

/// Whether a root is a surface that is seen.
bool counts(const Shape& shape, const LocalLine& line, const Root& root, double lambda_min) {
  ++roots_solved;
  const bool skipped = root.kind == RootKind::unresolved && shape.values[skips] != 0.0;
  return !skipped && line.lambda(root.t) > lambda_min;
}

FirstOnLine first_of(const Root& root) {
  return {root.t, root.kind == RootKind::unresolved};
}

/// The first root that counts, where the first of all does not.
FirstOnLine first_that_counts(const Shape& shape, const LocalLine& line, const LinePiece& piece,
                              double lambda_min) {
  RootWalk walk(*shape.formula, piece);
  for (Root root; walk.next(root);) {
    if (counts(shape, line, root, lambda_min)) return first_of(root);
  }
  return {};
}

/// Puts the question for the roots of a line beyond lambda_min, if it is inside the bounds there.
void ask(const Shape& shape, const LocalLine& line, double in, double out, double start, std::size_t i,
         Questions& q) {
  const double from = std::max(in, start);
  if (!(from <= out)) return;
  q.pieces.push_back({formula_line(shape, line), from, out});
  q.line_of.push_back(i);
}

void answer(const Shape& shape, Questions& q, RootsWanted wanted) {
  q.roots.resize(q.pieces.size());
  first_roots(*shape.formula, q.pieces, q.roots, finder_of(shape), nullptr, wanted);
}

/// Of lines of which the stretches within the bounds are known.
void first_crossings_within(const Shape& shape, const LocalLines& lines, const LineStretches& stretches,
                            double lambda_min, std::span<FirstOnLine> results) {
  std::fill_n(results.begin(), lines.count, FirstOnLine{});
  Questions& q = questions_of_thread();
  for (std::size_t i = 0; i < lines.count; ++i) {
    const LocalLine line = lines.line(i);
    ask(shape, line, stretches.in[i], stretches.out[i], lines.at_lambda(i, lambda_min), i, q);
  }
  answer(shape, q, RootsWanted::places);
  for (std::size_t k = 0; k < q.pieces.size(); ++k) {
    const Root& root = q.roots[k];
    if (!found(root)) continue;
    const LocalLine line = lines.line(q.line_of[k]);
    results[q.line_of[k]] = counts(shape, line, root, lambda_min)
                                ? first_of(root)
                                : first_that_counts(shape, line, q.pieces[k], lambda_min);
  }
}

void first_crossings_of(const Shape& shape, const LocalLines& lines, double lambda_min,
                        std::span<FirstOnLine> results) {
  const Shape* const one = &shape;
  LineStretches stretches;
  find_stretches({&one, 1}, lines, {&stretches, 1});
  first_crossings_within(shape, lines, stretches, lambda_min, results);
}

void blocks(const Shape& shape, const LocalLines& lines, double lambda_min, double lambda_max,
            std::span<bool> results) {
  std::fill_n(results.begin(), lines.count, false);
  Questions& q = questions_of_thread();
  LocalLines ending;  // before they leave the bounds: there the place of a root matters
  std::size_t line_of[LocalLines::most];
  const Shape* const one = &shape;
  LineStretches stretches, of_ending;
  find_stretches({&one, 1}, lines, {&stretches, 1});
  for (std::size_t i = 0; i < lines.count; ++i) {
    const LocalLine line = lines.line(i);
    const double in = stretches.in[i], out = stretches.out[i];
    if (lines.is_before(i, out, lambda_max)) {
      ask(shape, line, in, out, lines.at_lambda(i, lambda_min), i, q);
    } else {
      if (!(in <= out)) continue;
      line_of[ending.count] = i;
      of_ending.in[ending.count] = in;
      of_ending.out[ending.count] = out;
      ending.add(line);
    }
  }
  answer(shape, q, RootsWanted::existence);
  for (std::size_t k = 0; k < q.pieces.size(); ++k) {
    const Root& root = q.roots[k];
    if (!found(root)) continue;
    const LocalLine line = lines.line(q.line_of[k]);
    results[q.line_of[k]] = counts(shape, line, root, lambda_min) ||
                            first_that_counts(shape, line, q.pieces[k], lambda_min).t < infinite;
  }
  if (ending.count == 0) return;
  FirstOnLine first[LocalLines::most];
  first_crossings_within(shape, ending, of_ending, lambda_min, first);
  for (std::size_t k = 0; k < ending.count; ++k) {
    results[line_of[k]] = ending.lambda(k, first[k].t) < lambda_max;
  }
}

void begin_walk(const Shape& shape, const LocalLine& line, double from, const Stretch& within,
                SolidWalk& walk) {
  Stretch stretch = inside_bounds(shape, line);
  stretch.in = std::max(stretch.in, within.in);
  stretch.out = std::min(stretch.out, within.out);
  walk.begin(*shape.formula, formula_line(shape, line), stretch, from, shape.values[skips] == 0.0);
}

}  // namespace

const ShapeMethods implicit_methods{.kind = ShapeKind::implicit,
                                    .name = "implicit",
                                    .encloses = true,
                                    .problem = problem_of,
                                    .bounding_radius = radius_of,
                                    .half_extent = extent_of,
                                    .crossings = crossings_of_one,
                                    .point = point_of_one,
                                    .begin_walk = begin_walk,
                                    .first_crossings = first_crossings_of,
                                    .finder = finder_of,
                                    .points = implicit_points,
                                    .blocks = blocks};

std::uint64_t roots_solved_by_this_thread() {
  return roots_solved;
}

void count_root_solved() {
  ++roots_solved;
}

UnresolvedRoots unresolved_of(const Shape& shape) {
  return shape.kind == ShapeKind::implicit && shape.values[skips] != 0.0 ? UnresolvedRoots::skip
                                                                         : UnresolvedRoots::take;
}

Shape implicit(std::shared_ptr<const ImplicitFormula> f, Vec3 low, Vec3 high) {
  return implicit(std::move(f), low, high, ImplicitOptions{});
}

Shape implicit(std::shared_ptr<const ImplicitFormula> f, Vec3 low, Vec3 high,
               const ImplicitOptions& options) {
  Shape shape{ShapeKind::implicit, {low.x, low.y, low.z, high.x, high.y, high.z}, {}, {}, {}, {}};
  shape.values[time_scale] = options.seconds_per_length;
  shape.values[skips] = options.unresolved == UnresolvedRoots::skip ? 1.0 : 0.0;
  shape.formula = std::move(f);
  shape.blend = options.blend;
  shape.motion = options.motion;
  if (!problem_of(shape).empty()) return shape;
  const RootFinder finder = options.finder ? *options.finder : choose_root_finder(*shape.formula, low, high);
  shape.values[implicit_value::finder] = static_cast<double>(finder);
  return shape;
}

}  // namespace backlight
