#include "backlight/model/model_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>

#include "backlight/base/files.h"
#include "backlight/base/module.h"
#include "model_module.h"

namespace backlight {
namespace {

constexpr std::array<const char*, 5> endings{".obj", ".ply", ".stl", ".gltf", ".glb"};

Model model_of(const BacklightModel& given, const std::filesystem::path& folder) {
  Model model;
  MeshData& mesh = model.mesh;
  mesh.places.reserve(given.corners);
  const auto vector = [](const double* from) { return Vec3{from[0], from[1], from[2]}; };
  for (std::size_t i = 0; i < given.corners; ++i) mesh.places.push_back(vector(given.places + 3 * i));
  for (std::size_t i = 0; given.normals != nullptr && i < given.corners; ++i)
    mesh.normals.push_back(vector(given.normals + 3 * i));
  for (std::size_t i = 0; given.texture != nullptr && i < given.corners; ++i)
    mesh.texture.push_back({given.texture[2 * i], 1.0 - given.texture[2 * i + 1]});
  mesh.triangles.resize(given.triangles);
  for (std::size_t i = 0; i < given.triangles; ++i)
    std::copy_n(given.indices + 3 * i, 3, mesh.triangles[i].begin());
  mesh.members.assign(given.materials, given.materials + given.triangles);
  for (std::size_t i = 0; i < given.material_count; ++i) {
    const BacklightModelMaterial& its = given.material[i];
    ModelMaterial material;
    material.name = its.name;
    std::copy_n(its.color, 3, material.color.begin());
    std::copy_n(its.emission, 3, material.emission.begin());
    if (its.texture != nullptr) material.texture = folder / its.texture;
    if (its.embedded != nullptr) material.embedded_texture.assign(its.embedded, its.embedded_size);
    model.materials.push_back(std::move(material));
  }
  for (std::size_t i = 0; i < given.file_count; ++i) model.files.emplace_back(given.files[i]);
  if (given.missing != nullptr) model.missing = folder / given.missing;
  model.left_out = given.left_out;
  return model;
}

}  // namespace

bool is_model_name(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::ranges::find(endings, ending) != endings.end();
}

Result<Model> read_model(const std::filesystem::path& path, bool normals) {
  if (const Result<void> regular = require_regular_file(path); !regular.ok()) return regular.failure();
  const auto loaded = Module::load("libbacklight_models.so", "meshes");
  if (!loaded.ok()) return loaded.failure();
  BacklightModelsRead read = nullptr;
  BacklightModelsFree free = nullptr;
  if (!loaded.value().find("backlight_models_read_v1", read) ||
      !loaded.value().find("backlight_models_free_v1", free)) {
    return loaded.value().of_another_version();
  }
  BacklightModel given{};
  std::array<char, 512> text{};
  if (read(path.c_str(), normals ? 1 : 0, &given, text.data(), text.size()) != 0)
    return Failure{"cannot read " + path.string() + ": " + text.data()};
  const std::unique_ptr<BacklightModel, BacklightModelsFree> owner(&given, free);
  return model_of(given, path.parent_path());
}

}  // namespace backlight
