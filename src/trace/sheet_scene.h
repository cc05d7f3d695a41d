// What the sheets of one image share: frames as plain numbers, and the cones of all surfaces on the camera's
// sky and, as far as the moment allows, on the lights'.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "backlight/trace/hub.h"
#include "sheet.h"

namespace backlight {

/// A ConeTable with its memory.
class ConeStore {
 public:
  void resize(std::size_t count);
  [[nodiscard]] ConeTable& table() { return table_; }
  [[nodiscard]] const ConeTable& table() const { return table_; }

 private:
  ConeTable table_;
  // Not touched before it is used: of a large scene's lists most threads use a small part.
  std::unique_ptr<double[]> numbers_;
};

/// A LampTable with its memory.
class LampStore {
 public:
  void resize(std::size_t count);
  [[nodiscard]] LampTable& table() { return table_; }
  [[nodiscard]] const LampTable& table() const { return table_; }

 private:
  LampTable table_;
  // Not touched before it is used: of a large scene's lists most threads use a small part.
  std::unique_ptr<double[]> numbers_;
};

/// Something that a ray may meet: a surface, or many of a frame by SurfaceSet's own search.
struct Occupant {
  static constexpr int whole_frame = -1;
  static constexpr int all_bounded = -2;

  int frame = 0;
  int surface = whole_frame;           ///< or one of the above
  const LaneSurface* lanes = nullptr;  ///< of kind `other` where one ray goes at a time
  int first = 0;                       ///< of all_bounded: the occupant that the frame's surface 0 is
  bool in_tree = false;                ///< of a surface: found by the search of all_bounded alone
  int occluder = -1;  ///< of a surface: its index among the occluders, if it has one of its own
};

/// The view of one eye.
struct EyeView {
  std::vector<LaneFrame> frames;   ///< by frame index
  std::array<ConeStore, 2> cones;  ///< of occupants; [1]: with light delay
};

/// One light and its occluders.
struct LampView {
  bool in_lanes = false;  ///< its own frame is one that lanes can do
  std::vector<LaneMotion> to_frame;
  LampStore bounded;           ///< of occluders
  std::vector<int> unbounded;  ///< occluders without bounds
};

class SheetScene {
 public:
  SheetScene(const Scene& scene, const Hub& hub, const SheetKernels& kernels);

  [[nodiscard]] const SheetKernels& kernels() const { return *kernels_; }
  [[nodiscard]] const std::vector<Occupant>& occupants() const { return occupants_; }
  [[nodiscard]] const std::vector<Occupant>& occluders() const { return occluders_; }
  [[nodiscard]] const EyeView& eye(int eye) const { return eyes_[eye > 0 ? 1 : 0]; }
  [[nodiscard]] const LampView& lamp(std::size_t light) const { return lamps_[light]; }
  /// Frames of large γ, whose rays take extended precision: one ray at a time.
  [[nodiscard]] bool one_by_one(int frame) const { return one_by_one_[static_cast<std::size_t>(frame)]; }
  /// Whether all lights of points of this frame can be done in lanes.
  [[nodiscard]] bool lit_in_lanes(int frame) const { return lit_in_lanes_[static_cast<std::size_t>(frame)]; }

 private:
  void list_occupants(const Hub& hub);
  EyeView view_of(const Scene& scene, const Hub& hub, int eye) const;
  LampView view_of(const Scene& scene, const Hub& hub, std::size_t light) const;

  const SheetKernels* kernels_;
  std::vector<LaneSurface> lanes_;
  std::vector<Occupant> occupants_;
  std::vector<Occupant> occluders_;
  std::vector<EyeView> eyes_;
  std::vector<LampView> lamps_;
  std::vector<bool> one_by_one_;
  std::vector<bool> lit_in_lanes_;
};

/// Λ as plain numbers; of no use where it is robust.
template <class To, class From>
LaneMotion lane_motion(const LorentzTransform<To, From>& transform) {
  LaneMotion motion;
  motion.gamma = transform.gamma();
  motion.inverse_gamma_plus_one = transform.inverse_gamma_plus_one();
  motion.identity = transform.is_identity();
  motion.rotated = transform.is_rotated();
  for (int c = 0; c < 3; ++c) {
    motion.celerity[c] = transform.celerity()[c];
    for (int r = 0; r < 3; ++r) motion.rotation.column[c][r] = transform.rotation()[c][r];
  }
  return motion;
}

/// The displacement of an eye from the camera's event.
Displacement<Camera> eye_offset(const CameraView& camera, int eye);

}  // namespace backlight
