// Cylinders and cones.
#include <algorithm>

#include "convex.h"
#include "exact.h"

namespace backlight {
namespace {

/// x²+z² <= w(y)² with w = middle + slope·y >= 0: the side of a cylinder or of a cone.
void narrow_to_side(Stretch& stretch, double middle, double slope, const LocalLine& line) {
  const Vec3& p = line.point;
  const Vec3& d = line.direction;
  const double w = middle + slope * p.y;
  const double w_rate = slope * d.y;
  const double a = d.x * d.x + d.z * d.z - w_rate * w_rate;
  const double b = p.x * d.x + p.z * d.z - w * w_rate;
  const double c = p.x * p.x + p.z * p.z - w * w;
  // b² - ac by Lagrange's identity: a difference of two squares that is small only where the line is tangent.
  const double twist = difference_of_products(p.x, d.z, p.z, d.x);
  const double cone_x = difference_of_products(p.x, w_rate, w, d.x);
  const double cone_z = difference_of_products(p.z, w_rate, w, d.z);
  const double reach = std::sqrt(cone_x * cone_x + cone_z * cone_z);
  const double discriminant = (reach - std::abs(twist)) * (reach + std::abs(twist));

  if (a == 0.0 && b == 0.0) {
    if (c > 0.0) {
      stretch.close();
    }
    return;
  }
  if (a > 0.0 && !(discriminant >= 0.0)) {
    stretch.close();
    return;
  }
  if (a == 0.0) {
    const double root = -0.5 * c / b;
    b > 0.0 ? stretch.narrow(-infinite, 0, root, 0) : stretch.narrow(root, 0, infinite, 0);
    return;
  }
  // A line steeper than the cone (a < 0) always meets both nappes; rounding alone makes the discriminant
  // negative.
  const QuadraticRoots roots = quadratic_roots(a, b, c, std::max(discriminant, 0.0));
  const double low = std::min(roots.over_a, roots.under_c);
  const double high = std::max(roots.over_a, roots.under_c);
  if (a > 0.0) {
    stretch.narrow(low, 0, high, 0);
  } else if (w_rate > 0.0) {
    stretch.narrow(high, 0, infinite, 0);  // the nappe where w >= 0 lies ahead
  } else {
    stretch.narrow(-infinite, 0, low, 0);
  }
}

std::string cylinder_problem(const Shape& shape) {
  return first_of(unless_positive("radius", shape.values[0]), unless_positive("height", shape.values[1]));
}

std::string cone_problem(const Shape& shape) {
  const double radius = shape.values[0];
  const double top_radius = shape.values[1];
  const auto fits = [](double value) { return value >= 0.0 && std::isfinite(value); };
  if (!fits(radius)) {
    return "radius must be finite and not negative";
  }
  if (!fits(top_radius)) {
    return "top_radius must be finite and not negative";
  }
  if (radius == 0.0 && top_radius == 0.0) {
    return "radius and top_radius must not both be zero";
  }
  return unless_positive("height", shape.values[2]);
}

/// Radius at the bottom, at the top, and the height.
struct Frustum {
  double bottom;
  double top;
  double height;
};

Frustum frustum_of(const Shape& shape) {
  const auto& value = shape.values;
  return shape.kind == ShapeKind::cylinder ? Frustum{value[0], value[0], value[1]}
                                           : Frustum{value[0], value[1], value[2]};
}

double bounding_radius(const Shape& shape, const Vec3& factor) {
  const Frustum f = frustum_of(shape);
  return std::hypot(std::max(f.bottom, f.top) * std::max(factor.x, factor.z), 0.5 * f.height * factor.y);
}

double half_extent(const Shape& shape, const Extent& e) {
  const Frustum f = frustum_of(shape);
  return std::max(f.bottom, f.top) * e.circle + 0.5 * f.height * e.y;
}

Crossings crossings_of(const Shape& shape, const LocalLine& line, double /*lambda_min*/, Wanted /*wanted*/) {
  const Frustum f = frustum_of(shape);
  Stretch stretch;
  narrow_to_slab(stretch, line.point.y, line.direction.y, 0.5 * f.height, 1);
  narrow_to_side(stretch, 0.5 * (f.bottom + f.top), (f.top - f.bottom) / f.height, line);
  return stretch.ends();
}

LocalPoint point_of(const Shape& shape, const LocalLine& line, const Crossing& crossing) {
  const auto [bottom_radius, top_radius, height] = frustum_of(shape);
  const Vec3 p = line.at(crossing.t);
  const int part = crossing.part;
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

}  // namespace

const ShapeMethods cylinder_methods{ShapeKind::cylinder, "cylinder",      true,
                                    cylinder_problem,    bounding_radius, half_extent,
                                    crossings_of,        point_of,        nullptr};
const ShapeMethods cone_methods{ShapeKind::cone, "cone",       true,     cone_problem, bounding_radius,
                                half_extent,     crossings_of, point_of, nullptr};

Shape cylinder(double radius, double height) {
  return {ShapeKind::cylinder, {radius, height}, {}};
}

Shape cone(double radius, double top_radius, double height) {
  return {ShapeKind::cone, {radius, top_radius, height}, {}};
}

}  // namespace backlight
