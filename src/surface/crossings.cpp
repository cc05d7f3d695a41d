// Closed forms. The line comes re-origined at its closest approach to the local origin, with a unit
// direction, so every number here is of the size of the shape.
#include "crossings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The stretch of a line inside a convex body, with the faces at its ends. Bodies are intersected by
/// narrowing: a ray through an edge then either meets both faces or misses both, and can never slip in
/// between.
struct Stretch {
  double in = -infinity;
  double out = infinity;
  int part_in = 0;
  int part_out = 0;

  void narrow(double enter, int enter_part, double leave, int leave_part) {
    if (enter > in) {
      in = enter;
      part_in = enter_part;
    }
    if (leave < out) {
      out = leave;
      part_out = leave_part;
    }
  }
  void close() { out = -infinity; }

  [[nodiscard]] Crossings ends() const {
    Crossings result;
    if (in <= out && in > -infinity && out < infinity) {
      result.add(in, part_in);
      result.add(out, part_out);
    }
    return result;
  }
};

/// |coordinate| <= half, the faces being `low_part` and `low_part` + 1.
void narrow_to_slab(Stretch& stretch, double point, double direction, double half, int low_part) {
  if (direction > 0.0) {
    stretch.narrow((-half - point) / direction, low_part, (half - point) / direction, low_part + 1);
  } else if (direction < 0.0) {
    stretch.narrow((half - point) / direction, low_part + 1, (-half - point) / direction, low_part);
  } else if (!(std::abs(point) <= half)) {
    stretch.close();
  }
}

Crossings sphere_crossings(double radius, const LocalLine& line) {
  // Pythagoras on the perpendicular: no difference of squares of the distance to the viewer.
  const double square = radius * radius - glm::dot(line.point, line.point);
  Crossings result;
  if (square >= 0.0) {
    const double half_chord = std::sqrt(square);
    result.add(-half_chord, 0);
    result.add(half_chord, 0);
  }
  return result;
}

Crossings box_crossings(const Vec3& half, const LocalLine& line) {
  Stretch stretch;
  for (int axis = 0; axis < 3; ++axis) {
    narrow_to_slab(stretch, line.point[axis], line.direction[axis], half[axis], 2 * axis);
  }
  return stretch.ends();
}

/// The roots of a t² + 2 b t + c, without cancellation: q/a and c/q with q = -(b ± √(b²-ac)), b and the root
/// of the same sign. `discriminant` is b² - ac, non-negative.
struct QuadraticRoots {
  double over_a;  // may be infinite
  double under_c;
};

QuadraticRoots quadratic_roots(double a, double b, double c, double discriminant) {
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  if (q == 0.0) {
    return {0.0,
            0.0};  // b = 0 and ac = 0: a double root, or (a = 0) no proper equation, which callers exclude
  }
  return {q / a, c / q};
}

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
    b > 0.0 ? stretch.narrow(-infinity, 0, root, 0) : stretch.narrow(root, 0, infinity, 0);
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
    stretch.narrow(high, 0, infinity, 0);  // the nappe where w >= 0 lies ahead
  } else {
    stretch.narrow(-infinity, 0, low, 0);
  }
}

Crossings frustum_crossings(double bottom_radius, double top_radius, double height, const LocalLine& line) {
  Stretch stretch;
  narrow_to_slab(stretch, line.point.y, line.direction.y, 0.5 * height, 1);
  narrow_to_side(stretch, 0.5 * (bottom_radius + top_radius), (top_radius - bottom_radius) / height, line);
  return stretch.ends();
}

/// y = 0 inside `radius`.
Crossings flat_crossings(double radius, const LocalLine& line) {
  Crossings result;
  if (line.direction.y != 0.0) {
    const double t = -line.point.y / line.direction.y;
    const Vec3 p = line.at(t);
    if (p.x * p.x + p.z * p.z <= radius * radius) {
      result.add(t, 0);
    }
  }
  return result;
}

Crossings quadric_crossings(const std::array<double, 10>& q, const LocalLine& line) {
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
  if (std::abs(a) <= 8.0 * std::numeric_limits<double>::epsilon() * a_size) {
    a = 0.0;
  }
  const double b = glm::dot(half_gradient, d);
  const double c = glm::dot(half_gradient, p) + 0.5 * (q[6] * p.x + q[7] * p.y + q[8] * p.z) + q[9];
  const double discriminant = difference_of_products(b, b, a, c);
  Crossings result;
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

}  // namespace

Crossings crossings(const Shape& shape, const LocalLine& line, double lambda_min, Wanted wanted) {
  const auto& value = shape.values;
  switch (shape.kind) {
    case ShapeKind::sphere:
      return sphere_crossings(value[0], line);
    case ShapeKind::box:
      return box_crossings(0.5 * Vec3{value[0], value[1], value[2]}, line);
    case ShapeKind::cylinder:
      return frustum_crossings(value[0], value[0], value[1], line);
    case ShapeKind::cone:
      return frustum_crossings(value[0], value[1], value[2], line);
    case ShapeKind::torus:
      return torus_crossings(value[0], value[1], line, lambda_min, wanted);
    case ShapeKind::disk:
      return flat_crossings(value[0], line);
    case ShapeKind::plane:
      return flat_crossings(infinity, line);
    case ShapeKind::quadric:
      return quadric_crossings(value, line);
  }
  return {};
}

}  // namespace backlight
