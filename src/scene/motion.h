// How things move: the five ways of writing it, and the frames that come of them.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "backlight/scene/scene.h"
#include "values.h"

namespace backlight {

/// What numbers within their own limits come to when they are composed: more leaves no room for squares.
inline constexpr double greatest_composed = 1e130;

/// Whether no coordinate of the frame's origin and no component of its celerity is larger in size.
bool can_be_computed_with(const InertialFrame& frame);

/// Whether a table says how a thing moves.
bool has_motion(const TableView& table);

/// The celerity that a table's velocity, beta, gamma, celerity or rapidity stands for, in extended precision:
/// zero when it has none of them, or when they are wrong (and reported).
ExtendedVec3 read_celerity(const TableView& table, double c);

/// Where a thing is at rest.
struct RestPlace {
  int frame = 0;
  Vec3 position{0.0};
};

struct HashOfFrame {
  std::size_t operator()(const InertialFrame& frame) const;
};

/// The frames of a scene. Equal ones are one; a frame enters the scene when something is at rest in it.
class Frames {
 public:
  /// The frames that the description defines, at this image. `scene_frames` receives those that are used; its
  /// first one is the world.
  Frames(ImageValues& values, double c, std::vector<SceneFrame>& scene_frames);

  /// The frame called `name`; the world for a name that does not exist (which has been reported).
  [[nodiscard]] const InertialFrame& named(const std::string& name) const;

  /// The rest frame of a thing (object, light, sky), with the thing's position in it. `position` is as
  /// written: in coordinates of its frame, or of the world at world time 0 if it has a velocity.
  RestPlace rest_of(const TableView& thing, const Vec3& position);

  /// The rest frame that comes of a thing's own velocity, with its origin at the thing; nothing if that is
  /// the world, or wrong (and reported).
  std::optional<InertialFrame> own_motion(const TableView& thing);

  /// What is wrong with the keys of a thing that has no velocity of its own is reported.
  void check_at_rest(const TableView& thing);

  /// The index of a frame among the scene's; `name` is for one that is new there.
  int index_of(const InertialFrame& frame, const std::string& name);

  /// The index of one more of this frame, for a thing that moves in it: its bounds are another matter.
  int apart(const InertialFrame& frame, const std::string& name);

 private:
  void define(const std::string& name, const Node& written);
  ExtendedVec3 own_celerity(const TableView& thing);

  ImageValues& values_;
  double c_;
  std::vector<SceneFrame>& scene_frames_;
  std::unordered_map<std::string, InertialFrame> named_;
  std::unordered_map<InertialFrame, int, HashOfFrame> indices_;
};

}  // namespace backlight
