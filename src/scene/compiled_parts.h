// The parts of a scene that images of one description share, because nothing in them depends on the time.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "backlight/model/model_file.h"
#include "backlight/scene/scene.h"
#include "time_dependence.h"

namespace backlight {

/// Where each material is, which is the same in all images; and the materials, if that is so of them too.
struct MaterialPlan {
  struct Place {
    const Node* written = nullptr;  ///< null: the grey of what names no material
    std::string_view name;
    std::shared_ptr<const ModelMaterial> of_file{};  ///< of a mesh, which `written` names
  };
  std::vector<Place> places;  ///< by index into Scene::materials; empty unless there will be more images
  std::unordered_map<std::string, int> named;  ///< [material.NAME]
  std::unordered_map<const Node*, int> within_objects;
  std::unordered_map<const Node*, std::vector<int>> of_meshes;
  int grey = -1;
  bool changes = false;   ///< whether any depends on the time
  bool complete = false;  ///< all objects have been asked for theirs
  SharedVector<Material> made;
};

/// Objects that are at rest together whatever the time: those of one [frame.NAME], those of one velocity of
/// their own and one place, or a single one whose velocity depends on the time.
struct ObjectGroup {
  std::string frame;                    ///< its name, or empty
  std::optional<InertialFrame> motion;  ///< of their own
  int follows = -1;                     ///< the object whose velocity depends on the time
  bool apart = false;                   ///< one that moves in its frame, and has an entry of its own
  bool changes = false;                 ///< whether any surface depends on the time

  /// The surfaces of this group, and of `others` where their frames are equal: those of the last image in
  /// which none of them depended on the time.
  std::vector<int> others;
  std::shared_ptr<const SurfaceSet> surfaces;
  SharedVector<int> object_of_surface;
  std::vector<CopiesLeftOut> left_out;
};

struct ObjectPlan {
  std::vector<int> group_of;  ///< by object
  std::vector<ObjectGroup> groups;
  SharedVector<Object> objects;
};

struct CompiledParts {
  explicit CompiledParts(const Description& description) : dependence(description) {}

  TimeDependence dependence;
  bool kept = false;  ///< whether there will be more images
  MaterialPlan materials;
  ObjectPlan objects;
  std::optional<SharedVector<Star>> stars;
  bool brightness_is_foreseen = false;
  std::set<std::pair<int, int>> told_in_glass;  ///< what moves in which glass: objects
  std::optional<bool> lives_by_own_time;  ///< whether anything matter has goes by its own time; not asked yet
};

}  // namespace backlight
