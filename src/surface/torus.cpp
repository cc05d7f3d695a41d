// The torus: four roots, isolated before they are refined.
//
// On the line p + t d (d a unit vector, p ⟂ d) the torus is the quartic
//     F(t) = (t² + G)² - 4 R² q(t),   G = |p|² + R² - r²,   q = x² + z² at t,
// whose derivative, because p ⟂ d, is the depressed cubic 4 (t³ + P t + Q), P = G - 2R²a, Q = -2R²b, where
// a = dx²+dz², b = px dx + pz dz. The roots of the cubic (found between its own two extrema ±√(-P/3)) cut the
// line into pieces on which F is monotone: one root where the sign changes, none where it does not, and
// nothing to miss. (Isolation by the derivative's roots: C. Yuksel, "High-performance polynomial root finding
// for graphics", 2022.)
//
// F itself loses digits on thin tubes; signs and roots are taken from the distance form
//     g(t) = (ρ - R)² + y² - r²,  ρ = √(x²+z²),
// which is F divided by (ρ + R)² + y² - r² > 0 (as r < R), and is right to rounding of the coordinates.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "one_lane.h"
#include "surface_kernels.h"

namespace backlight {
namespace {

TorusQuestion question_of(const Shape& shape, double lambda_min) {
  return {shape.values[0], shape.values[1], lambda_min};
}

Crossings all_crossings(const Shape& shape, const LocalLine& line) {
  Lanes<1> roots[4];
  TorusLanes<Lanes<1>>::all_roots(question_of(shape, -infinite), one_lane(line), roots);
  Crossings result;
  for (const Lanes<1>& root : roots) {
    if (!std::isnan(root.v)) result.add(root.v, 0);
  }
  return result;
}

void first_crossings_of(const Shape& shape, const LocalLines& lines, double lambda_min,
                        std::span<FirstOnLine> results) {
  alignas(64) double roots[LocalLines::most];
  surface_kernels().torus_roots(question_of(shape, lambda_min), lines, roots);
  for (std::size_t k = 0; k < lines.count; ++k) {
    results[k] = {roots[k]};
    if (!(roots[k] < infinite) || lines.lambda(k, roots[k]) > lambda_min) continue;
    // A root at the very start.
    const LocalLine line = lines.line(k);
    const Crossings all = all_crossings(shape, line);
    int first = 0;
    while (first < all.count && !(line.lambda(all.list[first].t) > lambda_min)) ++first;
    results[k] = first < all.count ? FirstOnLine{all.list[first].t} : FirstOnLine{};
  }
}

void blocks(const Shape& shape, const LocalLines& lines, double lambda_min, double lambda_max,
            std::span<bool> results) {
  alignas(64) double roots[LocalLines::most];
  TorusQuestion question = question_of(shape, lambda_min);
  question.existence_is_enough = true;
  question.lambda_max = lambda_max;
  surface_kernels().torus_roots(question, lines, roots);
  for (std::size_t k = 0; k < lines.count; ++k) results[k] = lines.lambda(k, roots[k]) < lambda_max;
}

Crossings crossings_of(const Shape& shape, const LocalLine& line, double lambda_min, Wanted wanted) {
  return wanted == Wanted::all ? all_crossings(shape, line)
                               : crossings_of_one(shape, line, lambda_min, wanted);
}

void texture(const Shape& shape, int /*part*/, LocalPoint& point) {
  const Vec3& on = point.position;
  const double beside = std::sqrt(on.x * on.x + on.z * on.z) - shape.values[0];
  point.u = longitude(on.x, on.z);
  point.v = 0.5 - std::atan2(on.y, beside) * (0.5 * std::numbers::inv_pi);
}

std::string problem_of(const Shape& shape) {
  const double major = shape.values[0];
  const double minor = shape.values[1];
  const std::string sizes = first_of(unless_positive("major", major), unless_positive("minor", minor));
  return sizes.empty() && minor >= major ? "minor must be less than major" : sizes;
}

double bounding_radius(const Shape& shape, const Vec3& factor) {
  const double across = std::max(factor.x, factor.z);
  const double reach = (shape.values[0] + shape.values[1]) * across;
  return factor.y <= across ? reach : std::hypot(reach, shape.values[1] * factor.y);
}

double half_extent(const Shape& shape, const Extent& e) {
  return shape.values[0] * e.circle + shape.values[1] * e.sphere;
}

RootFinder finder_of(const Shape& /*shape*/) {
  return RootFinder::quartic;
}

}  // namespace

const ShapeMethods torus_methods{.kind = ShapeKind::torus,
                                 .name = "torus",
                                 .encloses = true,
                                 .problem = problem_of,
                                 .bounding_radius = bounding_radius,
                                 .half_extent = half_extent,
                                 .crossings = crossings_of,
                                 .point = point_by<TorusForm, texture>,
                                 .first_crossings = first_crossings_of,
                                 .finder = finder_of,
                                 .blocks = blocks,
                                 .texture = texture};

Shape torus(double major, double minor) {
  return {ShapeKind::torus, {major, minor}, {}, {}, {}};
}

}  // namespace backlight
