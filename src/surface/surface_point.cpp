#include "surface_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace backlight {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A point put onto the surface, in local coordinates. The gradient points outward and has any length.
struct LocalPoint {
  Vec3 position;
  Vec3 gradient;
  double u;
  double v;
  double error = 0.0;  // of the position, beyond rounding of the coordinates
};

/// Longitude about y as a fraction of a turn: 1/2 at +z, growing towards +x.
double longitude(double x, double z) {
  return 0.5 + std::atan2(x, z) * (0.5 * std::numbers::inv_pi);
}

LocalPoint on_sphere(double radius, const Vec3& p) {
  const Vec3 on = p * (radius / glm::length(p));
  return {on, on, longitude(on.x, on.z), std::atan2(std::hypot(on.x, on.z), on.y) * std::numbers::inv_pi};
}

LocalPoint on_box(const Vec3& size, const Vec3& p, int part) {
  const Vec3 half = 0.5 * size;
  const int axis = part / 2;
  const double side = part % 2 == 0 ? -1.0 : 1.0;
  Vec3 on = glm::clamp(p, -half, half);
  on[axis] = side * half[axis];
  Vec3 normal{0.0};
  normal[axis] = side;
  const Vec3 f = on / size;  // -1/2..1/2
  switch (axis) {
    case 0:
      return {on, normal, 0.5 - side * f.z, 0.5 - f.y};
    case 1:
      return {on, normal, 0.5 + f.x, 0.5 + side * f.z};
    default:
      return {on, normal, 0.5 + side * f.x, 0.5 - f.y};
  }
}

/// A disc of `radius` at height y that faces up (side = 1) or down (side = -1).
LocalPoint on_disc(double radius, double y, double side, const Vec3& p) {
  const double scale = 0.5 / radius;
  return {{p.x, y, p.z}, {0.0, side, 0.0}, 0.5 + p.x * scale, 0.5 + side * p.z * scale};
}

LocalPoint on_frustum(double bottom_radius, double top_radius, double height, const Vec3& p, int part) {
  const double half = 0.5 * height;
  if (part != 0) {
    return part == 2 ? on_disc(top_radius, half, 1.0, p) : on_disc(bottom_radius, -half, -1.0, p);
  }
  const double y = std::clamp(p.y, -half, half);
  const double slope = (top_radius - bottom_radius) / height;
  const double wanted = std::max(0.5 * (bottom_radius + top_radius) + slope * y, 0.0);
  const double rho = std::hypot(p.x, p.z);
  const double scale = rho > 0.0 ? wanted / rho : 0.0;
  // On the axis there is only the apex, whose normal is taken along the axis.
  const Vec3 gradient =
      rho > 0.0 ? Vec3{p.x / rho, -slope, p.z / rho} : Vec3{0.0, slope < 0.0 ? 1.0 : -1.0, 0.0};
  return {{p.x * scale, y, p.z * scale}, gradient, longitude(p.x, p.z), 0.5 - y / height};
}

LocalPoint on_torus(double major, double minor, const Vec3& p) {
  const double rho = std::hypot(p.x, p.z);
  const double beside = rho - major;
  const double scale = minor / std::hypot(beside, p.y);
  const double on_rho = major + beside * scale;
  const Vec3 on{p.x * (on_rho / rho), p.y * scale, p.z * (on_rho / rho)};
  const Vec3 gradient{p.x / rho * beside, p.y, p.z / rho * beside};
  return {on, gradient, longitude(p.x, p.z), 0.5 - std::atan2(p.y, beside) * (0.5 * std::numbers::inv_pi)};
}

LocalPoint on_quadric(const std::array<double, 10>& q, const Vec3& p) {
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

LocalPoint on_shape(const Shape& shape, const Vec3& p, int part) {
  const auto& value = shape.values;
  switch (shape.kind) {
    case ShapeKind::sphere:
      return on_sphere(value[0], p);
    case ShapeKind::box:
      return on_box({value[0], value[1], value[2]}, p, part);
    case ShapeKind::cylinder:
      return on_frustum(value[0], value[0], value[1], p, part);
    case ShapeKind::cone:
      return on_frustum(value[0], value[1], value[2], p, part);
    case ShapeKind::torus:
      return on_torus(value[0], value[1], p);
    case ShapeKind::disk:
      return on_disc(value[0], 0.0, 1.0, p);
    case ShapeKind::plane:
      return {{p.x, 0.0, p.z}, {0.0, 1.0, 0.0}, p.x, p.z};
    case ShapeKind::quadric:
      return on_quadric(value, p);
  }
  return {};
}

double largest(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

}  // namespace

SurfacePoint surface_point(const PlacedSurface& surface, const Vec3& local, int part) {
  const LocalPoint point = on_shape(surface.shape, local, part);
  const Mat3& rest_from_local = surface.placement.rest_from_local();
  const Vec3 offset = rest_from_local * point.position;
  SurfacePoint result;
  result.position = surface.placement.position() + offset;
  // A gradient is a covector: it goes by the transposed inverse, which also keeps it outward in a mirror
  // image.
  result.normal = glm::normalize(glm::transpose(surface.placement.local_from_rest()) * point.gradient);
  result.u = point.u;
  result.v = point.v;
  const double reach = std::isfinite(surface.radius) ? surface.radius : 2.0 * glm::length(offset);
  result.error_bound = 16.0 * epsilon * (largest(surface.placement.position()) + reach) +
                       point.error * largest(surface.placement.scale());
  return result;
}

}  // namespace backlight
