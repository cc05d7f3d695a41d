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
  table.warning("file", "of the mesh, " + what + " are left out: they cannot be seen");
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

void require_closed(const TableView& table, std::string_view key, const Mesh& mesh, const std::string& what) {
  if (mesh.is_closed()) return;
  table.error(key,
              "the mesh is not closed, and cannot be " + what +
                  ": not each of its edges is that of two triangles that go along it in opposite ways",
              "close its holes and make its normals consistent in the program that it comes from");
}

void warn_without_texture_coordinates(const TableView& table, const Mesh& mesh) {
  if (!mesh.data().texture.empty()) return;
  table.warning("file",
                "the mesh has no texture coordinates: all of it shows one place of its texture or checker",
                "lay it out (UV) in the program that it comes from, or give it a color");
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
