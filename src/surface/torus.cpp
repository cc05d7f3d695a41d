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
// The first root of many lines is found over lanes (torus_lanes.h), by the same equations. A solid's parts
// want all roots: those are found here, one line at a time.
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

struct ValueAndSlope {
  double value;
  double slope;
};

struct DepressedCubic {
  double p;
  double q;

  [[nodiscard]] double value(double t) const { return (t * t + p) * t + q; }
  [[nodiscard]] ValueAndSlope operator()(double t) const { return {value(t), 3.0 * t * t + p}; }
};

struct TorusAlongLine {
  const LocalLine& line;
  double major;
  double minor;

  [[nodiscard]] double value(double t) const { return (*this)(t).value; }
  [[nodiscard]] ValueAndSlope operator()(double t) const {
    const Vec3 p = line.at(t);
    const double rho = std::sqrt(p.x * p.x + p.z * p.z);
    const double beside = rho - major;
    const double rho_rate = rho > 0.0 ? (p.x * line.direction.x + p.z * line.direction.z) / rho : 0.0;
    return {(beside - minor) * (beside + minor) + p.y * p.y,
            2.0 * (beside * rho_rate + p.y * line.direction.y)};
  }
};

/// The root of f in [low, high], at whose ends f has different signs (zero counts as negative): Newton's
/// steps, with a bisection wherever the step leaves the bracket or is not less than half the step before.
template <class Function>
double bracketed_root(const Function& f, double low, double high, bool negative_at_low, double size) {
  const double tolerance = 1e-16 * size;
  double t = 0.5 * (low + high);
  double step = high - low;
  double step_before = step;
  while (true) {
    const ValueAndSlope at = f(t);
    ((at.value <= 0.0) == negative_at_low ? low : high) = t;
    const double newton = at.value / at.slope;
    if (std::abs(newton) <= tolerance) {
      return std::clamp(t - newton, low, high);
    }
    const bool useful =
        t - newton > low && t - newton < high && 2.0 * std::abs(newton) < std::abs(step_before);
    step_before = step;
    const double next = useful ? t - newton : low + 0.5 * (high - low);
    step = useful ? newton : 0.5 * (high - low);
    if (std::abs(step) <= tolerance || next == t) {
      return next;  // the bracket is as small as rounding lets it be
    }
    t = next;
  }
}

/// Points that cut [low, high] into pieces on which the torus's quartic is monotone, low and high included.
struct Cuts {
  int count = 0;
  double t[5];
};

Cuts monotone_pieces(const DepressedCubic& cubic, double low, double high) {
  double extrema[4] = {low, high, high, high};
  int pieces = 1;
  if (cubic.p < 0.0) {
    const double extremum = std::sqrt(-cubic.p / 3.0);
    extrema[1] = std::clamp(-extremum, low, high);
    extrema[2] = std::clamp(extremum, low, high);
    pieces = 3;
  }
  Cuts cuts;
  cuts.t[cuts.count++] = low;
  const double size = std::max(std::abs(low), std::abs(high));
  for (int i = 0; i < pieces; ++i) {
    const double from = extrema[i];
    const double to = extrema[i + 1];
    const bool negative = cubic.value(from) <= 0.0;
    if (from < to && negative != (cubic.value(to) <= 0.0)) {
      cuts.t[cuts.count++] = bracketed_root(cubic, from, to, negative, size);
    }
  }
  cuts.t[cuts.count++] = high;
  return cuts;
}

/// The stretch of the line where the torus can be: inside its sphere and between its two flat tangent planes,
/// a hair wider than both so that the ends are outside. False: nowhere.
bool clip(const LocalLine& line, double major, double minor, double& low, double& high) {
  const double outer = (major + minor) * (1.0 + 1e-9);
  const double square = outer * outer - glm::dot(line.point, line.point);
  if (!(square >= 0.0)) {
    return false;
  }
  high = std::sqrt(square);
  low = -high;
  const double half = minor * (1.0 + 1e-9);
  const double y = line.point.y;
  const double rate = line.direction.y;
  if (rate != 0.0) {
    const double one = (-half - y) / rate;
    const double other = (half - y) / rate;
    low = std::max(low, std::min(one, other));
    high = std::min(high, std::max(one, other));
  } else if (std::abs(y) > half) {
    return false;
  }
  return low < high;
}

Crossings all_crossings(const Shape& shape, const LocalLine& line) {
  const double major = shape.values[0];
  const double minor = shape.values[1];
  Crossings result;
  double low = 0.0;
  double high = 0.0;
  if (!clip(line, major, minor, low, high)) {
    return result;
  }
  const Vec3& p = line.point;
  const Vec3& d = line.direction;
  const double square = major * major;
  const DepressedCubic cubic{glm::dot(p, p) + square - minor * minor - 2.0 * square * (d.x * d.x + d.z * d.z),
                             -2.0 * square * (p.x * d.x + p.z * d.z)};
  const Cuts cuts = monotone_pieces(cubic, low, high);
  const TorusAlongLine torus{line, major, minor};
  const double size = major + minor;
  bool inside = false;
  for (int i = 1; i < cuts.count; ++i) {
    const bool inside_next = i + 1 < cuts.count && torus.value(cuts.t[i]) <= 0.0;
    if (inside_next != inside) {
      result.add(bracketed_root(torus, cuts.t[i - 1], cuts.t[i], inside, size), 0);
    }
    inside = inside_next;
  }
  return result;
}

TorusQuestion question_of(const Shape& shape, double lambda_min) {
  return {shape.values[0], shape.values[1], lambda_min};
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
  if (wanted == Wanted::all) return all_crossings(shape, line);
  LocalLines one;
  one.add(line);
  FirstOnLine first;
  first_crossings_of(shape, one, lambda_min, {&first, 1});
  Crossings result;
  if (first.t < infinite) result.add(first.t, 0);
  return result;
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
