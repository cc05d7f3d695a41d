// Wavefront OBJ by tinyobjloader, in double precision.
#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "read_model.h"

namespace backlight::models {
namespace {

/// Finds .mtl files beside the model, and keeps a list of them.
class MaterialFiles : public tinyobj::MaterialReader {
 public:
  explicit MaterialFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* numbers, std::string* warnings, std::string* errors) override {
    const std::filesystem::path path = folder_ / name;
    std::ifstream file(path);
    if (!file || !std::filesystem::is_regular_file(path)) {
      missing.push_back(name);
      return true;  // whether it matters is known when a face names a material of it
    }
    tinyobj::LoadMtl(numbers, materials, &file, warnings, errors);
    files.push_back(path.string());
    return true;
  }

  std::vector<std::string> files, missing;

 private:
  std::filesystem::path folder_;
};

Material material_of(const tinyobj::material_t& given) {
  Material material;
  material.name = given.name;
  material.texture = given.diffuse_texname;
  std::replace(material.texture.begin(), material.texture.end(), '\\', '/');
  for (std::size_t k = 0; k < 3; ++k) {
    material.color[k] = given.diffuse[k];
    material.emission[k] = given.emission[k];
  }
  // Many exporters write black beside a texture.
  if (!material.texture.empty() && material.color == std::array{0.0, 0.0, 0.0})
    material.color = {1.0, 1.0, 1.0};
  return material;
}

std::size_t index_of(int index, std::size_t count, const char* what) {
  if (index >= 0 && static_cast<std::size_t>(index) < count) return static_cast<std::size_t>(index);
  throw std::runtime_error("a face names " + std::string(what) + " " +
                           std::to_string(std::int64_t{index} + 1) + ", and there are " +
                           std::to_string(count));
}

}  // namespace

Read read_obj(const std::string& path, bool normals) {
  check_obj_text(path);
  std::ifstream file(path);
  tinyobj::attrib_t all;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warnings, errors;
  MaterialFiles material_files(std::filesystem::path(path).parent_path());
  if (!tinyobj::LoadObj(&all, &shapes, &materials, &warnings, &errors, &file, &material_files, true, false)) {
    while (!errors.empty() && std::isspace(static_cast<unsigned char>(errors.back())) != 0) errors.pop_back();
    throw std::runtime_error(errors.empty() ? "it is no OBJ file" : errors.substr(0, errors.find('\n')));
  }
  Read read;
  read.files = material_files.files;
  for (const tinyobj::material_t& its : materials) read.materials.push_back(material_of(its));
  const auto none = static_cast<std::uint32_t>(read.materials.size());
  read.materials.emplace_back();
  const auto corner_of = [&](const tinyobj::index_t& index) {
    Corner corner;
    const std::size_t place = index_of(index.vertex_index, all.vertices.size() / 3, "the vertex");
    std::copy_n(&all.vertices[3 * place], 3, corner.place.begin());
    read.corners.has_normals = read.corners.has_normals && index.normal_index >= 0;
    if (normals && index.normal_index >= 0) {
      const std::size_t normal = index_of(index.normal_index, all.normals.size() / 3, "the normal");
      std::copy_n(&all.normals[3 * normal], 3, corner.normal.begin());
    }
    if (index.texcoord_index >= 0) {
      const std::size_t at = index_of(index.texcoord_index, all.texcoords.size() / 2, "the texture vertex");
      std::copy_n(&all.texcoords[2 * at], 2, corner.texture.begin());
      read.corners.has_texture = true;
    }
    return read.corners.add(corner);
  };
  for (tinyobj::shape_t& shape : shapes) {
    const tinyobj::mesh_t& mesh = shape.mesh;
    std::size_t first = 0;
    for (std::size_t face = 0; face < mesh.num_face_vertices.size(); ++face) {
      const std::size_t corners = mesh.num_face_vertices[face];
      if (corners != 3) {
        ++read.left_out;
        first += corners;
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) read.indices.push_back(corner_of(mesh.indices[first + k]));
      first += 3;
      const int material = mesh.material_ids[face];
      const bool known = material >= 0 && static_cast<std::uint32_t>(material) < none;
      read.materials_of_triangles.push_back(known ? static_cast<std::uint32_t>(material) : none);
    }
    read.left_out += shape.lines.num_line_vertices.size();
    shape = {};
  }
  if (!material_files.missing.empty()) read.missing = material_files.missing.front();
  return read;
}

}  // namespace backlight::models
