// Meshes and their materials from the files of other programs.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "backlight/base/result.h"
#include "backlight/surface/mesh.h"

namespace backlight {

/// What a file says of a material.
struct ModelMaterial {
  std::string name;
  std::array<double, 3> color{0.8, 0.8, 0.8};  ///< linear reflectance; times the texture's, if there is one
  std::array<double, 3> emission{0.0, 0.0, 0.0};  ///< linear; 0 or more
  std::filesystem::path texture;                  ///< a picture of reflectances, or empty
  std::string embedded_texture;                   ///< or the bytes of its file
};

/// A file's triangles, all of its parts in one, where its own scene graph puts them; `members` are the
/// materials.
struct Model {
  MeshData mesh;
  std::vector<ModelMaterial> materials;      ///< at least one
  std::vector<std::filesystem::path> files;  ///< others that it takes something from
  std::filesystem::path missing;  ///< a file of materials that it names and that is not there; or empty
  /// Faces of less than three corners (points, lines), which were left out.
  std::size_t left_out = 0;
};

/// Whether the name ends as those that read_model() takes: .obj, .ply, .stl, .gltf, .glb, in any case.
bool is_model_name(const std::filesystem::path& path);

/// Reads Wavefront OBJ (in double precision), PLY, STL or glTF 2 (in single). Polygons are cut into
/// triangles. Texture coordinates are turned so that v goes downwards. `normals`: whether the file's are
/// wanted; they are kept where every corner has one. Fails, with the path and the reason, on a file that is
/// missing, damaged, cut short, or has numbers that are not finite or indices of nothing.
Result<Model> read_model(const std::filesystem::path& path, bool normals);

}  // namespace backlight
