// Solids made up at random, and the other way to say what is inside them: the inequalities of their shapes,
// and and, or, not.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "backlight/surface/implicit.h"
#include "backlight/surface/solid.h"
#include "backlight/surface/surface_set.h"

namespace backlight::testing {

/// Where the numbers of a solid and of the rays at it come from.
class Choices {
 public:
  virtual ~Choices() = default;
  virtual double uniform(double low, double high) = 0;
  virtual int below(int count) = 0;

  Vec3 vector(double half) {
    const double x = uniform(-half, half);
    const double y = uniform(-half, half);
    return {x, y, uniform(-half, half)};
  }
};

/// Formulas with many roots on a line, and with surfaces that cross each other.
inline const std::vector<ImplicitFormula>& formulas() {
  static const std::vector<ImplicitFormula> all = [] {
    std::vector<ImplicitFormula> list;
    for (const char* text :
         {"cos(6*x)*sin(6*y) + cos(6*y)*sin(6*z) + cos(6*z)*sin(6*x)",
          "x^4 + y^4 + z^4 - x^2 - y^2 - z^2 + 0.3", "(x^2 + y^2 + z^2 - 0.5)*(x - 0.1)"}) {
      list.emplace_back(std::get<Expression>(Expression::parse(text, {"x", "y", "z", "t"})));
    }
    return list;
  }();
  return all;
}

inline Shape some_shape(Choices& choose) {
  const double a = choose.uniform(0.3, 1.0);
  const double b = choose.uniform(0.3, 1.0);
  switch (choose.below(8)) {
    case 0:
      return sphere(a);
    case 1:
      return box({a, 2 * b, 1.0});
    case 2:
      return cylinder(a, 2 * b);
    case 3:
      return torus(a, 0.6 * a * b);
    case 4:
      return plane();
    case 5:
      return cone(a, choose.below(2) == 0 ? 0.0 : b, 1.0);
    case 6:
      return quadric({1, choose.below(2) == 0 ? 1.0 : -b, 0.5, 0, 0, 0, 0, 0, 0, -a * a});
    default:
      break;
  }
  const auto& f = formulas()[static_cast<std::size_t>(choose.below(static_cast<int>(formulas().size())))];
  return implicit(std::make_shared<const ImplicitFormula>(f), {-a, -1.0, -b}, {a, 1.0, b});
}

/// A solid of operations nested at most `depth` deep.
inline SolidTree some_solid(Choices& choose, int depth) {
  const Vec3 position = choose.vector(0.6);
  const Vec3 turn = choose.vector(180.0);
  const double stretch = choose.uniform(0.6, 1.4);
  SolidTree tree;
  tree.placement = Placement(position, turn, Vec3{stretch, choose.uniform(0.6, 1.4), 1.0});
  if (depth == 0 || choose.below(4) == 0) {
    tree.shape = some_shape(choose);
    tree.member = choose.below(5);
    return tree;
  }
  tree.operation = static_cast<SolidOperation>(choose.below(3));
  for (int i = choose.below(4); i >= 0; --i) tree.parts.push_back(some_solid(choose, depth - 1));
  return tree;
}

/// Whether a point is inside a shape, in its local coordinates.
inline bool inside(const Shape& shape, const Vec3& p) {
  const auto& v = shape.values;
  const double rho = std::hypot(p.x, p.z);
  switch (shape.kind) {
    case ShapeKind::sphere:
      return glm::length(p) < v[0];
    case ShapeKind::box:
      return std::abs(p.x) < v[0] / 2 && std::abs(p.y) < v[1] / 2 && std::abs(p.z) < v[2] / 2;
    case ShapeKind::cylinder:
      return rho < v[0] && std::abs(p.y) < v[1] / 2;
    case ShapeKind::cone:
      return rho < v[0] + (v[1] - v[0]) * (p.y / v[2] + 0.5) && std::abs(p.y) < v[2] / 2;
    case ShapeKind::torus:
      return std::hypot(rho - v[0], p.y) < v[1];
    case ShapeKind::quadric:
      return v[0] * p.x * p.x + v[1] * p.y * p.y + v[2] * p.z * p.z + v[9] < 0.0;
    case ShapeKind::implicit:
      return p.x > v[0] && p.y > v[1] && p.z > v[2] && p.x < v[3] && p.y < v[4] && p.z < v[5] &&
             shape.formula->value(p) < 0.0;
    default:
      return p.y < 0.0;  // the plane
  }
}

inline bool inside(const SolidTree& tree, const Vec3& outer) {
  const Vec3 p = tree.placement.local_from_rest() * (outer - tree.placement.position());
  if (tree.parts.empty()) return inside(tree.shape, p);
  bool result = inside(tree.parts[0], p);
  for (std::size_t i = 1; i < tree.parts.size(); ++i) {
    const bool other = inside(tree.parts[i], p);
    if (tree.operation == SolidOperation::unite) result = result || other;
    if (tree.operation == SolidOperation::intersect) result = result && other;
    if (tree.operation == SolidOperation::difference) result = result && !other;
  }
  return result;
}

/// How many hits were looked at, and how many of them so near to an edge that their two sides tell nothing.
struct Looked {
  int hits = 0;
  int edges = 0;
};

/// Follows a ray hit after hit: between two of them membership never changes, across each it does, and the
/// normal points to the outside. Says what is wrong, or nothing.
inline std::string wrong_along(const SolidTree& tree, const SurfaceSet& set, const Vec3& origin,
                               const Vec3& direction, Looked& looked) {
  constexpr double end = 12.0;
  double from = 0.0;
  for (int k = 0; k < 12 && from < end; ++k) {
    const Vec3 start = origin + from * direction;
    const Hit hit = set.nearest(start, direction);
    const double to = std::min(hit.found() ? from + hit.lambda : end, end);
    // Closer than this the samples may be on the surface.
    if (to - from < 1e-6) return {};
    const bool state = inside(tree, origin + 0.5 * (from + to) * direction);
    for (int m = 1; m < 32; ++m) {
      const double at = from + (to - from) * m / 32.0;
      if (inside(tree, origin + at * direction) != state) return "a surface was missed or invented";
    }
    if (!hit.found() || to == end) return {};
    const SurfacePoint point = set.resolve(hit, start, direction);
    if (!(glm::length(point.position - (origin + to * direction)) <= 1e-11))
      return "the point is off the ray";
    if (!hit.unresolved && std::abs(glm::dot(point.normal, direction)) > 1e-3) {
      const bool behind = inside(tree, point.position - 1e-7 * point.normal);
      const bool before = inside(tree, point.position + 1e-7 * point.normal);
      if (before && !behind) return "the sides of the surface are exchanged";
      looked.edges += before == behind ? 1 : 0;
      if ((glm::dot(point.normal, direction) > 0.0) != state) return "the normal points inwards";
    }
    from = to + 1e-9;
    ++looked.hits;
  }
  return {};
}

}  // namespace backlight::testing
