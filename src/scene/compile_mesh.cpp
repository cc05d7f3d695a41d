#include "compile_mesh.h"

#include "materials.h"

namespace backlight {
namespace {

// What was left out is said once for each place that names the file.
void warn_of_left_out(const TableView& table, const LoadedModel& model) {
  std::string what;
  const auto add = [&](std::size_t count, const std::string& words) {
    if (count > 0) what += (what.empty() ? "" : " and ") + std::to_string(count) + words;
  };
  add(model.mesh->dropped(),
      model.mesh->dropped() == 1 ? " triangle without an area" : " triangles without an area");
  add(model.left_out, model.left_out == 1 ? " point or line" : " points and lines");
  if (what.empty()) return;
  table.values().diagnostics.warning(table.values().description.span(table.place("file")),
                                     "of the mesh, " + what + " are left out: they cannot be seen");
}

}  // namespace

std::shared_ptr<const LoadedModel> model_of(Compilation& c, const TableView& table) {
  const Node* written = table.node_of("file");
  if (written == nullptr || written->text() == nullptr) return nullptr;
  const std::filesystem::path path = resolve_path(table.values(), *written);
  if (!is_model_name(path)) {
    table.error("file", "'" + path.filename().string() + "' is no mesh by its name",
                "meshes are .obj, .ply, .stl, .gltf and .glb");
    return nullptr;
  }
  auto model = c.cache.model(path, table.boolean("smooth"));
  if (model.ok()) return model.value();
  table.error("file", model.error());
  return nullptr;
}

bool has_materials_of_file(const TableView& table) {
  const Node* written = table.node_of("material");
  return table.text("shape") == "mesh" && written != nullptr && written->text() != nullptr &&
         *written->text() == "file";
}

std::optional<Shape> compile_mesh(Compilation& c, const TableView& table) {
  const auto model = model_of(c, table);
  if (!model) return std::nullopt;
  const Shape shape = mesh(model->mesh, has_materials_of_file(table));
  if (const std::string wrong = problem(shape); !wrong.empty()) {
    table.error("file", wrong);
    return std::nullopt;
  }
  warn_of_left_out(table, *model);
  return shape;
}

}  // namespace backlight
