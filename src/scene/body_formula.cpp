#include "body_formula.h"

#include <string>
#include <vector>

#include "backlight/expression/compose.h"
#include "backlight/surface/implicit_surface.h"
#include "compile_formulas.h"
#include "words.h"

namespace backlight {
namespace {

/// Everywhere within a body's own box f is as it was, and outside it is undefined: an open surface ends
/// there.
Expression within_box(const Expression& f, const Vec3& low, const Vec3& high, bool closed) {
  std::string inside;
  const char* const names[3] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    const std::string middle = number_text(0.5 * low[i] + 0.5 * high[i]);
    const std::string half = number_text(0.5 * high[i] - 0.5 * low[i]);
    inside += std::string(i > 0 ? ", " : "") + "abs(" + names[i] + " - (" + middle + ")) - " + half;
  }
  const std::string box = "max(" + inside + ")";
  const std::string text = closed ? "max(f, " + box + ")" : "f + 0*sqrt(-" + box + ")";
  const Expression outer = std::get<Expression>(Expression::parse(text, {"x", "y", "z", "t", "f"}));
  Composer composer(ImplicitFormula::variables);
  std::vector<Composer::Node> at;
  for (std::size_t i = 0; i < ImplicitFormula::variables; ++i) at.push_back(composer.variable(i));
  at.push_back(composer.insert(f, at));
  return composer.expression(composer.insert(outer, at), f.text());
}

}  // namespace

std::optional<Expression> body_formula(Compilation& c, const TableView& table, const Shape& shape,
                                       bool closed) {
  const auto& v = shape.values;
  switch (shape.kind) {
    case ShapeKind::sphere:
      return formula_of_text("x^2 + y^2 + z^2 - r^2", {"r"}, {v[0]});
    case ShapeKind::box:
      return formula_of_text("max(abs(x) - a, abs(y) - b, abs(z) - c)", {"a", "b", "c"},
                             {0.5 * v[0], 0.5 * v[1], 0.5 * v[2]});
    case ShapeKind::cylinder:
      return formula_of_text("max(x^2 + z^2 - r^2, abs(y) - h)", {"r", "h"}, {v[0], 0.5 * v[1]});
    case ShapeKind::cone:
      return formula_of_text("max(x^2 + z^2 - (m + k*y)^2, abs(y) - h)", {"m", "k", "h"},
                             {0.5 * (v[0] + v[1]), (v[1] - v[0]) / v[2], 0.5 * v[2]});
    case ShapeKind::torus:
      return formula_of_text("(sqrt(x^2 + z^2) - major)^2 + y^2 - minor^2", {"major", "minor"}, {v[0], v[1]});
    case ShapeKind::disk:
      return formula_of_text("y + 0*sqrt(r^2 - x^2 - z^2)", {"r"}, {v[0]});
    case ShapeKind::quadric:
      if (!is_infinite(shape)) return formula_of(shape);
      [[fallthrough]];
    case ShapeKind::plane:
      table.error("shape", "a surface without bounds cannot move: far away it would be faster than light",
                  "a disk or a box of the size that is seen can");
      return std::nullopt;
    case ShapeKind::implicit: {
      const Vec3 low{v[0], v[1], v[2]};
      const Vec3 high{v[3], v[4], v[5]};
      const auto bounds = c.cache.bounds(*shape.formula);
      const bool whole = bounds && !bounds->inside_beyond && bounds->low.x >= low.x &&
                         bounds->low.y >= low.y && bounds->low.z >= low.z && bounds->high.x <= high.x &&
                         bounds->high.y <= high.y && bounds->high.z <= high.z;
      const Expression& f = shape.formula->expression();
      return whole ? f : within_box(f, low, high, closed);
    }
    case ShapeKind::mesh:
      table.error(
          "shape", "a mesh has no formula, and cannot turn or swing in its frame",
          "it can move with its frame: give a velocity or a [frame.NAME]; image_time instead of t puts "
          "it somewhere else for each image");
      return std::nullopt;
    case ShapeKind::csg:
    case ShapeKind::travelling_ball:
      break;
  }
  return std::nullopt;
}

}  // namespace backlight
