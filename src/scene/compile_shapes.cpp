#include "compile_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "compile_formulas.h"
#include "compile_mesh.h"

namespace backlight {
namespace {

Shape read_quadric(const TableView& table) {
  const std::vector<double> written = table.numbers("coefficients");
  std::array<double, 10> coefficients{};
  std::copy(written.begin(), written.end(), coefficients.begin());
  return quadric(coefficients);
}

// The closed forms: their names in a file, and how their keys become a shape.
struct ClosedForm {
  std::string_view name;
  Shape (*read)(const TableView&);
};

constexpr std::array<ClosedForm, 8> closed_forms{{
    {"sphere", [](const TableView& t) { return sphere(t.number("radius")); }},
    {"box", [](const TableView& t) { return box(t.vector("size")); }},
    {"cylinder", [](const TableView& t) { return cylinder(t.number("radius"), t.number("height")); }},
    {"cone",
     [](const TableView& t) { return cone(t.number("radius"), t.number("top_radius"), t.number("height")); }},
    {"torus", [](const TableView& t) { return torus(t.number("major"), t.number("minor")); }},
    {"disk", [](const TableView& t) { return disk(t.number("radius")); }},
    {"plane", [](const TableView&) { return plane(); }},
    {"quadric", read_quadric},
}};

std::optional<SolidOperation> operation_of(const std::string& shape) {
  if (shape == "union") return SolidOperation::unite;
  if (shape == "intersection") return SolidOperation::intersect;
  if (shape == "difference") return SolidOperation::difference;
  return std::nullopt;
}

class ShapeReader {
 public:
  ShapeReader(Compilation& c, Materials& materials) : c_(c), materials_(materials) {}

  std::optional<CompiledShape> object(const TableView& table, int material) {
    if (!table.complete()) return std::nullopt;
    const auto operation = operation_of(table.text("shape"));
    if (!operation) {
      auto shape = single(table);
      if (!shape) return std::nullopt;
      if (shape->mesh) take_material(table, *shape, material);
      return CompiledShape{*shape, members_, {}, centre_of(*shape)};
    }
    if (is_blend(table)) {
      auto shape = blend(table, material, 1);
      if (!shape) return std::nullopt;
      return CompiledShape{*std::move(shape), members_, {}};
    }
    if (has_keys_of_blends(table)) return std::nullopt;
    SolidTree tree;
    tree.operation = *operation;
    if (!parts(table, material, 1, tree)) return std::nullopt;
    return CompiledShape{csg(tree), members_, tree};
  }

 private:
  // A shape that is not made of others.
  std::optional<Shape> single(const TableView& table) {
    const std::size_t errors = c_.values.diagnostics.error_count();
    const std::string name = table.text("shape");
    if (name == "implicit") return compile_implicit(c_, table);
    if (name == "mesh") return compile_mesh(c_, table);
    const auto* form = std::find_if(closed_forms.begin(), closed_forms.end(),
                                    [&](const ClosedForm& candidate) { return candidate.name == name; });
    if (form == closed_forms.end()) return std::nullopt;
    const Shape shape = form->read(table);
    if (c_.values.diagnostics.error_count() > errors) return std::nullopt;
    if (const std::string wrong = problem(shape); !wrong.empty()) {
      table.error("shape", wrong);
      return std::nullopt;
    }
    return shape;
  }

  // All parts, so that what is wrong with any of them is reported; false if something is.
  bool parts(const TableView& table, int material, int depth, SolidTree& tree) {
    const Node* written = table.node_of("part");
    if (depth > deepest_solid) {
      table.error("part", "solids are nested deeper than " + std::to_string(deepest_solid) + " operations");
      return false;
    }
    if (written == nullptr || written->array() == nullptr || written->array()->empty()) return false;
    bool good = true;
    for (const Node& node : *written->array()) {
      auto part = one_part(TableView(c_.values, &node, *find_table("object.part")), material, depth);
      if (part) {
        tree.parts.push_back(*std::move(part));
      } else {
        good = false;
      }
    }
    return good;
  }

  std::optional<SolidTree> one_part(const TableView& table, int inherited, int depth) {
    const std::size_t errors = c_.values.diagnostics.error_count();
    const int material = table.has("material") ? materials_.of(table) : inherited;
    SolidTree tree;
    tree.placement = Placement(table.vector("position"), table.vector("rotate"), read_scale(table));
    if (!table.complete()) return std::nullopt;
    if (const std::string wrong = problem(tree.placement); !wrong.empty()) {
      table.error(table.has("scale") ? "scale" : "position", wrong);
    }
    const auto operation = operation_of(table.text("shape"));
    if (operation && !is_blend(table)) {
      if (has_keys_of_blends(table)) return std::nullopt;
      tree.operation = *operation;
      if (!parts(table, material, depth + 1, tree)) return std::nullopt;
    } else {
      auto shape = operation ? blend(table, material, depth + 1) : single(table);
      if (!shape) return std::nullopt;
      tree.shape = *std::move(shape);
      const auto own = tree.shape.mesh ? take_material(table, tree.shape, material) : std::nullopt;
      tree.member = own ? *own : operation ? 0 : member(material);
      if (centre_of(tree.shape) != Vec3{0.0})
        tree.placement = tree.placement.around(Placement(centre_of(tree.shape)));
      if (tree.shape.mesh) {
        require_closed(table, "shape", *tree.shape.mesh, "part of a solid");
      } else if (!is_solid(tree.shape)) {
        table.error("shape", problem(tree), "a cylinder of little height has an inside");
      }
    }
    if (c_.values.diagnostics.error_count() > errors) return std::nullopt;
    return tree;
  }

  static bool is_blend(const TableView& table) {
    return table.text("shape") == "union" && table.has_valid("blend");
  }

  // What would be read and do nothing is an error.
  static bool has_keys_of_blends(const TableView& table) {
    if (table.text("shape") != "union" || table.has("blend")) return false;
    bool any = false;
    for (const std::string_view key : {"bounds", "unresolved"}) {
      if (!table.has(key)) continue;
      any = true;
      table.error(key, "only a union with blend has '" + std::string(key) + "'",
                  "write it in the parts that are formulas, or add blend");
    }
    return any;
  }

  std::optional<Shape> blend(const TableView& table, int material, int depth) {
    const Node* written = table.node_of("part");
    if (depth > deepest_solid || written == nullptr || written->array() == nullptr) return std::nullopt;
    std::vector<BlendPart> parts;
    bool good = true;
    for (const Node& node : *written->array()) {
      auto part = blend_part(TableView(c_.values, &node, *find_table("object.part")), material);
      if (part) {
        parts.push_back(*std::move(part));
      } else {
        good = false;
      }
    }
    if (!good || parts.empty()) return std::nullopt;
    return compile_blend(c_, table, parts);
  }

  std::optional<BlendPart> blend_part(const TableView& table, int inherited) {
    const int material = table.has("material") ? materials_.of(table) : inherited;
    BlendPart part;
    part.placement = Placement(table.vector("position"), table.vector("rotate"), read_scale(table));
    part.member = member(material);
    if (!table.complete()) return std::nullopt;
    if (const std::string wrong = problem(part.placement); !wrong.empty()) {
      table.error(table.has("scale") ? "scale" : "position", wrong);
      return std::nullopt;
    }
    if (table.text("shape") == "implicit") {
      part.bounds = written_bounds(table);
      if (table.has("unresolved")) {
        table.error("unresolved", "a part of a blend has no surface of its own",
                    "write unresolved in the union, for the blend as a whole");
        return std::nullopt;
      }
      auto formula = bound_formula(c_, table);
      if (!formula) return std::nullopt;
      part.formula = *std::move(formula);
      return part;
    }
    if (operation_of(table.text("shape"))) {
      table.error("shape", "a blend takes formulas and simple shapes, not solids made of others",
                  "list their parts in this union itself");
      return std::nullopt;
    }
    const auto shape = single(table);
    auto formula = shape ? formula_of(*shape) : std::nullopt;
    if (shape && !formula) {
      table.error("shape", "a " + table.text("shape") + " has no formula to blend",
                  "write one: shape = \"implicit\" with f");
    }
    if (!formula) return std::nullopt;
    part.formula = *std::move(formula);
    return part;
  }

  static Vec3 centre_of(const Shape& shape) { return shape.mesh ? shape.mesh->centre() : Vec3{0.0}; }

  // Of a mesh: adds the materials of its own file as members, if they are asked for, and returns the first
  // one's number.
  std::optional<int> take_material(const TableView& table, const Shape& shape, int material) {
    if (shape.values[0] != 1.0) {
      if (materials_.has_pattern(material)) warn_without_texture_coordinates(table, *shape.mesh);
      return std::nullopt;
    }
    const int first = static_cast<int>(members_.size());
    const auto own = materials_.of_model(table, *model_of(c_, table));
    members_.insert(members_.end(), own.begin(), own.end());
    return first;
  }

  int member(int material) {
    const auto there = std::find(members_.begin(), members_.end(), material);
    const auto index = static_cast<int>(there - members_.begin());
    if (there == members_.end()) members_.push_back(material);
    return index;
  }

  Compilation& c_;
  Materials& materials_;
  std::vector<int> members_;
};

}  // namespace

Vec3 read_scale(const TableView& table) {
  const Node* written = table.node_of("scale");
  const bool three = written != nullptr && written->array() != nullptr;
  const Vec3 scale = three ? table.vector("scale") : Vec3{table.number("scale")};
  constexpr double least = 1e-50;  // the inverse of the greatest
  for (int i = 0; i < 3; ++i) {
    if (scale[i] == 0.0 || std::abs(scale[i]) >= least) continue;  // zero is reported with the placement
    table.error("scale", "'scale' is " + number_text(scale[i]) + ", but must be at least " +
                             number_text(least) + " in size");
    return Vec3{1.0};
  }
  return scale;
}

std::optional<CompiledShape> compile_shape(Compilation& c, const TableView& object, Materials& materials,
                                           int material) {
  auto compiled = ShapeReader(c, materials).object(object, material);
  if (!compiled || !object.has_valid("visible")) return compiled;
  if (const auto formula = object.in_own_time("visible")) {
    compiled->shape.presence = std::make_shared<const Presence>(Presence{*formula, 1.0 / c.scene.c});
  } else if (object.number("visible") <= 0.0) {
    object.error("visible", "'visible' is never positive: the object is never there", "remove the object");
  }
  return compiled;
}

}  // namespace backlight
