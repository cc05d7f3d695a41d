// The materials that meshes bring with them.
#include <algorithm>

#include "materials.h"

namespace backlight {
namespace {

void warn_without_any(const TableView& object, const LoadedModel& model) {
  const auto says_nothing = [usual = ModelMaterial{}](const auto& its) {
    return its->name.empty() && its->texture.empty() && its->embedded_texture.empty() &&
           its->color == usual.color && its->emission == usual.emission;
  };
  if (!std::ranges::all_of(model.materials, says_nothing)) return;
  object.warning("material", "the mesh's file tells of no material: all of it is grey (0.8)");
}

}  // namespace

std::vector<int> Materials::of_model(const TableView& object, const LoadedModel& model) {
  const Node* written = object.node_of("material");
  const auto known = plan_.of_meshes.find(written);
  if (known != plan_.of_meshes.end()) return known->second;
  if (model.missing.empty()) {
    warn_without_any(object, model);
  } else {
    object.error("material",
                 "the mesh takes its materials from " + model.missing.string() + ", which is missing",
                 "put it there, or give a material of the scene");
  }
  std::vector<int> members;
  for (const auto& its : model.materials) members.push_back(add({written, {}, its}));
  if (parts_.kept) plan_.of_meshes.emplace(written, members);
  return members;
}

void Materials::read_of_file(const MaterialPlan::Place& place) {
  const ModelMaterial& given = *place.of_file;
  Material& material = materials_.emplace_back();
  LinearRgb color{0.0}, emission{0.0};
  for (int k = 0; k < 3; ++k) {
    color[k] = std::clamp(given.color[static_cast<std::size_t>(k)], 0.0, 1.0);
    emission[k] = std::max(given.emission[static_cast<std::size_t>(k)], 0.0);
  }
  if (given.texture.empty() && given.embedded_texture.empty()) {
    material.reflectance.rgb = color;
    pending_.push_back({materials_.size() - 1, nullptr, std::nullopt, std::nullopt});
  } else {
    material.reflectance = {Spectrum::constant(0.8), LinearRgb{0.8}};
    auto texture = cache_.texture_of(given, color);
    if (texture.ok()) {
      material.texture = texture.value();
    } else {
      values_.diagnostics.error(values_.description.span(place.written->place), texture.error(),
                                "it is the texture of the mesh's material '" + given.name + "'");
    }
  }
  if (emission.r > 0.0 || emission.g > 0.0 || emission.b > 0.0)
    material.emission = std::make_shared<const Colour>(times(coloured_light(emission), exposure_));
}

}  // namespace backlight
