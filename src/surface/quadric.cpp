#include <algorithm>

#include "convex.h"
#include "exact.h"

namespace backlight {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

std::string problem_of(const Shape& shape) {
  const auto& c = shape.values;
  if (!std::all_of(c.begin(), c.end(), [](double value) { return std::isfinite(value); })) {
    return "coefficients must be finite";
  }
  // The last one is a constant: it makes no surface.
  if (std::all_of(c.begin(), c.end() - 1, [](double value) { return value == 0.0; })) {
    return "at least one of the first nine coefficients must not be zero";
  }
  return {};
}

double no_radius(const Shape& /*shape*/, const Vec3& /*factor*/) {
  return infinite;
}

double no_extent(const Shape& /*shape*/, const Extent& /*e*/) {
  return infinite;
}

Crossings crossings_of(const Shape& shape, const LocalLine& line, double /*lambda_min*/, Wanted /*wanted*/) {
  const auto& q = shape.values;
  const Vec3& p = line.point;
  const Vec3& d = line.direction;
  // f(p + t d) = a t² + 2 b t + c; `half_gradient` is ∇f/2.
  const Vec3 half_gradient{q[0] * p.x + 0.5 * (q[3] * p.y + q[4] * p.z + q[6]),
                           q[1] * p.y + 0.5 * (q[3] * p.x + q[5] * p.z + q[7]),
                           q[2] * p.z + 0.5 * (q[4] * p.x + q[5] * p.y + q[8])};
  const double terms[6] = {q[0] * d.x * d.x, q[1] * d.y * d.y, q[2] * d.z * d.z,
                           q[3] * d.x * d.y, q[4] * d.x * d.z, q[5] * d.y * d.z};
  double a = 0.0;
  double a_size = 0.0;
  for (const double term : terms) {
    a += term;
    a_size += std::abs(term);
  }
  // Along an asymptote the quadratic term is rounding noise, and would invent a crossing some 1e16 lengths
  // away.
  if (std::abs(a) <= 8.0 * epsilon * a_size) {
    a = 0.0;
  }
  const double b = glm::dot(half_gradient, d);
  const double c = glm::dot(half_gradient, p) + 0.5 * (q[6] * p.x + q[7] * p.y + q[8] * p.z) + q[9];
  const double discriminant = difference_of_products(b, b, a, c);
  Crossings result;
  // The sign of f far back along the line.
  result.inside_before = a != 0.0 ? a < 0.0 : b != 0.0 ? b > 0.0 : c < 0.0;
  if (!(discriminant >= 0.0) || (a == 0.0 && b == 0.0)) {
    return result;
  }
  if (a == 0.0) {
    result.add(-0.5 * c / b, 0);
    return result;
  }
  const QuadraticRoots roots = quadratic_roots(a, b, c, discriminant);
  result.add(std::min(roots.over_a, roots.under_c), 0);
  result.add(std::max(roots.over_a, roots.under_c), 0);
  return result;
}

LocalPoint point_of(const Shape& shape, const LocalLine& line, const Crossing& crossing) {
  const auto& q = shape.values;
  const Vec3 p = line.at(crossing.t);
  const Vec3 gradient{2.0 * q[0] * p.x + q[3] * p.y + q[4] * p.z + q[6],
                      2.0 * q[1] * p.y + q[3] * p.x + q[5] * p.z + q[7],
                      2.0 * q[2] * p.z + q[4] * p.x + q[5] * p.y + q[8]};
  const double terms[10] = {
      q[0] * p.x * p.x, q[1] * p.y * p.y, q[2] * p.z * p.z, q[3] * p.x * p.y, q[4] * p.x * p.z,
      q[5] * p.y * p.z, q[6] * p.x,       q[7] * p.y,       q[8] * p.z,       q[9]};
  double value = 0.0;
  double size = 0.0;
  for (const double term : terms) {
    value += term;
    size += std::abs(term);
  }
  const double square = glm::dot(gradient, gradient);
  const double curvature = *std::max_element(q.begin(), q.begin() + 6,
                                             [](double a, double b) { return std::abs(a) < std::abs(b); });
  if (square == 0.0) {
    return {p, {0.0, 1.0, 0.0}, p.x, p.z, std::sqrt(4.0 * epsilon * size / std::abs(curvature))};
  }
  // The value of f is uncertain by some epsilon·size: near a singular point (a cone's apex) that is far in
  // space.
  const double by_slope = 8.0 * epsilon * size / std::sqrt(square);
  const double by_curvature = std::sqrt(8.0 * epsilon * size / std::abs(curvature));
  const double step = std::abs(value) <= std::sqrt(epsilon) * size ? value / square : 0.0;
  const Vec3 on = p - step * gradient;
  return {on, gradient, on.x, on.z, curvature != 0.0 ? std::min(by_slope, by_curvature) : by_slope};
}

}  // namespace

const ShapeMethods quadric_methods{ShapeKind::quadric, "quadric",    true,     problem_of, no_radius,
                                   no_extent,          crossings_of, point_of, nullptr};

Shape quadric(const std::array<double, 10>& coefficients) {
  return {ShapeKind::quadric, coefficients, {}};
}

}  // namespace backlight
