#include <array>
#include <cmath>

#include "compile_shapes.h"

namespace backlight {
namespace {

constexpr double most_copies = 1e7;

// How often, and how far apart.
struct Lattice {
  std::array<int, 3> count{1, 1, 1};
  Vec3 step{0.0};
};

Lattice read_lattice(const TableView& object) {
  Lattice lattice;
  if (!object.has_valid("repeat")) return lattice;
  const TableView repeat = object.table("repeat", "object.repeat");
  if (!repeat.complete()) return lattice;
  const Vec3 count = repeat.vector("count");
  lattice.step = repeat.vector("step");
  if (count.x * count.y * count.z > most_copies) {
    object.error("repeat", "more than " + number_text(most_copies) + " copies");
    return lattice;
  }
  if (count.x < 1.0 || count.y < 1.0 || count.z < 1.0) return lattice;  // reported before
  for (int i = 0; i < 3; ++i) lattice.count[static_cast<std::size_t>(i)] = static_cast<int>(count[i]);
  return lattice;
}

// One object with its copies, x counting fastest.
void add_copies(SceneFrame& frame, int object, const Shape& shape, const Placement& first,
                const Lattice& lattice, const Vec3& rotate) {
  for (int k = 0; k < lattice.count[2]; ++k)
    for (int j = 0; j < lattice.count[1]; ++j)
      for (int i = 0; i < lattice.count[0]; ++i) {
        const Vec3 offset = Vec3{double(i), double(j), double(k)} * lattice.step;
        frame.surfaces.add(shape, Placement(first.position() + offset, rotate, first.scale()));
        frame.object_of_surface.push_back(object);
      }
}

void compile_object(Compilation& c, const Node& node, Materials& materials) {
  const TableView table(c.values, &node, *find_table("object"));
  const std::size_t errors = c.values.diagnostics.error_count();
  Object object;
  object.name = table.text("name");
  object.id = static_cast<int>(c.scene.objects.size()) + 1;
  object.material = materials.of(table);
  const Vec3 rotate = table.vector("rotate");
  const RestPlace place = c.frames.rest_of(table, table.vector("position"));
  const Placement placement(place.position, rotate, read_scale(table));
  const Lattice lattice = read_lattice(table);
  const auto compiled = compile_shape(c, table, materials, object.material);
  if (compiled) object.member_materials = compiled->member_materials;
  c.scene.objects.push_back(object);
  if (!compiled || c.values.diagnostics.error_count() > errors) return;
  if (const std::string wrong = problem(placement); !wrong.empty()) {
    return table.error(table.has("scale") ? "scale" : "position", wrong);
  }
  SceneFrame& frame = c.scene.frames[static_cast<std::size_t>(place.frame)];
  add_copies(frame, object.id - 1, compiled->shape, placement, lattice, rotate);
}

}  // namespace

void compile_objects(Compilation& c) {
  Materials materials(c.values, c.cache, c.scene.materials);
  const Entry* objects = find(c.values.description.root, "object");
  if (objects != nullptr && objects->node.array() != nullptr) {
    for (const Node& node : *objects->node.array()) compile_object(c, node, materials);
  }
  materials.finish();
}

}  // namespace backlight
