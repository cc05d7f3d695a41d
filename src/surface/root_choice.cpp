// The choice is made by counting: the same on every machine, in every run.
#include "root_choice.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "backlight/surface/implicit_surface.h"

namespace backlight {
namespace {

constexpr int probes = 32;

/// What a search does with one answer, besides the evaluation.
constexpr EvaluationCosts for_each_answer{60.0, 60.0, 40.0, 40.0, 60.0, 0.0};

/// A line that is given up costs as much as this many evaluations over a piece, one line at a time.
constexpr double cost_of_walk = 1000.0;

/// A form that does not exist is found out one line at a time, and delays its neighbours: so many forms.
constexpr double cost_of_no_form = 60.0;

EvaluationCosts operator+(const EvaluationCosts& a, const EvaluationCosts& b) {
  return {a.piece + b.piece, a.point + b.point,           a.number + b.number,
          a.form + b.form,   a.polynomial + b.polynomial, a.part + b.part};
}

EvaluationCosts cost_of(Operation operation) {
  switch (operation) {
    case Operation::constant:
    case Operation::variable:
      return {6.0, 6.0, 3.0, 12.0};
    case Operation::negate:
      return {1.0, 1.0, 1.0, 2.0};
    case Operation::add:
    case Operation::subtract:
      return {4.0, 2.0, 2.0, 8.0};
    case Operation::multiply:
      return {59.0, 19.0, 4.0, 23.0};
    case Operation::square:
      return {34.0, 9.0, 4.0, 16.0};
    case Operation::integer_power:
      return {110.0, 40.0, 12.0, 50.0};
    case Operation::divide:
      return {140.0, 30.0, 30.0, 80.0};
    case Operation::sqrt:
      return {110.0, 40.0, 40.0, 90.0};
    case Operation::sin:
    case Operation::cos:
      return {340.0, 160.0, 130.0, 90.0};
    case Operation::abs:
    case Operation::min:
    case Operation::max:
      return {50.0, 8.0, 10.0, 40.0};
    default:  // functions of the C library, lane by lane
      return {1500.0, 700.0, 400.0, 2500.0};
  }
}

/// Points of a cube of edge 1, evenly spread (M. Roberts' sequence for three dimensions: powers of the
/// root of x⁴ = x + 1).
Vec3 spread(int i) {
  const Vec3 at = (0.5 + i) * Vec3{0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  return at - glm::floor(at);
}

/// The line through a point of the box, from its entrance or from the point on.
LinePiece probe_line(int i, const Vec3& low, const Vec3& high) {
  const Vec3 point = low + spread(2 * i) * (high - low);
  Vec3 direction = 2.0 * spread(2 * i + 1) - 1.0;
  direction /= std::sqrt(glm::dot(direction, direction));
  LinePiece line{{{point.x, point.y, point.z, 0.0}, {direction.x, direction.y, direction.z, 0.0}},
                 -std::numeric_limits<double>::infinity(),
                 std::numeric_limits<double>::infinity()};
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) continue;
    const double one = (low[axis] - point[axis]) / direction[axis];
    const double other = (high[axis] - point[axis]) / direction[axis];
    line.from = std::max(line.from, std::min(one, other));
    line.to = std::min(line.to, std::max(one, other));
  }
  if (i % 2 != 0) line.from = 0.0;
  return line;
}

/// Of a step in the arithmetic of polynomials: products of coefficients and their sums, sums of magnitudes.
double polynomial_cost(const LineProgram::Step& step) {
  const double each = 20.0;  // to go on to the next step, for the lanes of one register
  const double a = step.degree_a + 1.0;
  const double b = step.degree_b + 1.0;
  switch (step.operation) {
    case Operation::constant:
    case Operation::variable:
      return each;
    case Operation::multiply:
      if (step.constant_a || step.constant_b) return each + 4.0 * step.degree;
      return each + 2.0 * a * b + 3.0 * (a + b);
    case Operation::square:
      return each + a * a + 6.0 * a;
    case Operation::integer_power:
      return each + 4.0 * step.degree * step.degree;
    default:
      return each + 4.0 * step.degree;
  }
}

/// Of Taylor's shift, Bernstein's form and the signs of its coefficients. Lanes wait for each other: half as
/// much again.
double part_cost(int degree) {
  return 1.5 * (2.0 * degree * degree + 14.0 * degree + 30.0);
}

}  // namespace

EvaluationCosts evaluation_costs(const LineProgram& program) {
  EvaluationCosts sum;
  for (const LineProgram::Step& step : program.steps()) {
    sum = sum + cost_of(step.operation);
    if (program.degree()) sum.polynomial += polynomial_cost(step);
  }
  if (program.degree()) sum.part = part_cost(*program.degree());
  return sum;
}

double cost_of(const RootWork& work, const EvaluationCosts& costs) {
  const EvaluationCosts each = costs + for_each_answer;
  return static_cast<double>(work.cells) * each.piece + static_cast<double>(work.points) * each.point +
         static_cast<double>(work.polish) * each.number + static_cast<double>(work.forms) * each.form +
         static_cast<double>(work.polynomials) * each.polynomial +
         static_cast<double>(work.parts) * each.part +
         static_cast<double>(work.without_form) * cost_of_no_form * costs.form +
         static_cast<double>(work.given_up) * cost_of_walk * costs.piece;
}

RootWork probe(const ImplicitFormula& f, const Vec3& low, const Vec3& high, RootFinder finder) {
  std::vector<LinePiece> lines;
  for (int i = 0; i < probes; ++i) lines.push_back(probe_line(i, low, high));
  std::vector<Root> roots(lines.size());
  RootWork work;
  work.only_count = true;
  first_roots(f, lines, roots, finder, &work);
  return work;
}

RootFinder choose_root_finder(const ImplicitFormula& f, const Vec3& low, const Vec3& high) {
  const EvaluationCosts costs = evaluation_costs(f.program());
  RootFinder best = RootFinder::interval;
  double least = std::numeric_limits<double>::infinity();
  for (const RootFinder finder : {RootFinder::interval, RootFinder::affine, RootFinder::polynomial}) {
    if (finder == RootFinder::polynomial && !f.program().degree()) continue;
    const double cost = cost_of(probe(f, low, high, finder), costs);
    if (!(cost < least)) continue;
    best = finder;
    least = cost;
  }
  return best;
}

}  // namespace backlight
