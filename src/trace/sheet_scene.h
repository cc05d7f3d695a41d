// What the sheets of one image share: frames as plain numbers, and the cones of all surfaces on the camera's
// sky and, as far as the moment allows, on the lights'.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "backlight/trace/tracer.h"
#include "sheet.h"

namespace backlight {

/// A ConeTable or a LampTable with its memory.
template <class Table>
class TableStore {
 public:
  void resize(std::size_t count) {
    const std::size_t column = (count + 8) / 4 * 4;  // with room for a register of any width behind the last
    const auto columns = table_.columns();
    numbers_ = column <= small ? std::make_unique<double[]>(columns.size() * column)
                               : std::make_unique_for_overwrite<double[]>(columns.size() * column);
    for (std::size_t i = 0; i < columns.size(); ++i) *columns[i] = numbers_.get() + i * column;
    table_.count = static_cast<int>(count);
  }
  [[nodiscard]] Table& table() { return table_; }
  [[nodiscard]] const Table& table() const { return table_; }

 private:
  Table table_;
  // A large one is not touched before it is used: most threads use a small part. In a small one, what is left
  // in memory behind the last would be a large part of what a kernel takes: of denormal numbers, too, which
  // are slow.
  static constexpr std::size_t small = 512;
  std::unique_ptr<double[]> numbers_;
};
using ConeStore = TableStore<ConeTable>;
using LampStore = TableStore<LampTable>;

/// A frame with surfaces: what a ray may meet, by its own search.
struct Entry {
  int frame = 0;
  int first_number = 0;        ///< the number of its surface 0: they are counted through all frames
  bool extended = false;       ///< of large γ, whose rays take extended precision: one ray at a time
  bool casts_shadows = false;  ///< any of its surfaces
  bool travels =
      false;  ///< any goes along a path, it is not extended, and the camera's event bounds what is seen
};

/// A surface by its number.
struct Numbered {
  int entry;
  int group;  ///< of the surfaces whose points are lit together: of one frame and material
};

/// The view of one eye.
struct EyeView {
  std::vector<LaneFrame> frames;      ///< by frame index
  std::array<ConeStore, 2> cones;     ///< of entries; [1]: with light delay
  std::vector<PassingBall> passings;  ///< by entry: what light that arrives meets of it
};

/// One light and its occluders.
struct LampView {
  bool in_lanes = false;  ///< its own frame is one that lanes can do
  std::vector<LaneMotion> to_frame;
  LampStore bounded;            ///< entries that cast shadows
  std::vector<int> unbounded;   ///< the same without bounds...
  std::vector<int> travellers;  ///< ...unless by the moment: they go along paths
  bool any_travels = false;     ///< of all these
};

class SheetScene {
 public:
  enum class From { camera, relay };  ///< whose hub it is: a relay has but one eye

  SheetScene(const Tracer& tracer, const Hub& hub, const SheetKernels& kernels, From from);

  [[nodiscard]] const SheetKernels& kernels() const { return *kernels_; }
  [[nodiscard]] const Hub& hub() const { return *hub_; }
  /// Whether the rays that a relay passes on can go in sheets: no frame is of large γ relative to it.
  [[nodiscard]] bool suits_relay() const;
  /// Of a relay's: around the surfaces of an entry; of infinite radius if they have no bounds.
  [[nodiscard]] const LaneBall& ball(std::size_t entry) const { return balls_[entry]; }
  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  [[nodiscard]] const Entry& entry(int index) const { return entries_[static_cast<std::size_t>(index)]; }
  [[nodiscard]] const Numbered& numbered(int number) const {
    return numbered_[static_cast<std::size_t>(number)];
  }
  [[nodiscard]] std::size_t group_count() const { return groups_.size(); }
  /// Whether the points of the group are lighted one at a time, by the law: their material is another one at
  /// each time.
  [[nodiscard]] bool goes_singly(int group) const { return groups_[static_cast<std::size_t>(group)].singly; }
  /// Whether the matter of the group may not be at rest in its frame.
  [[nodiscard]] bool moves(int group) const { return groups_[static_cast<std::size_t>(group)].moves; }
  [[nodiscard]] const SurfaceSet& surfaces(const Entry& entry) const {
    return *hub_->frames[static_cast<std::size_t>(entry.frame)].scene->surfaces;
  }
  [[nodiscard]] const EyeView& eye(int eye) const { return eyes_[eye > 0 ? 1 : 0]; }
  [[nodiscard]] const LampView& lamp(std::size_t light) const { return lamps_[light]; }
  /// Adds to the table how light of a lamp that makes up the bundle meets these entries of travellers: in a
  /// sphere each, but for those that it does not meet before they are seen by the camera. `passings`, by
  /// entry: what it meets of each.
  void add_travellers(const Scene& scene, std::size_t light, std::span<const int> entries,
                      const Bundle& bundle, LampTable& table, std::span<PassingBall> passings) const;
  /// Whether all lights of points of this frame can be done in lanes.
  [[nodiscard]] bool lit_in_lanes(int frame, const Effects& effects) const {
    // Of a lamp on a path, γ is another one for each point: only this effect asks for it.
    const bool by_gamma = lamps_move_ && effects.brightness.arrival_rate == ArrivalRate::dilation;
    return lit_in_lanes_[static_cast<std::size_t>(frame)] && !by_gamma;
  }

 private:
  void list_entries(const Scene& scene, From from);
  [[nodiscard]] EyeView view_of(const Scene& scene, int eye) const;
  [[nodiscard]] LampView view_of(const Scene& scene, std::size_t light) const;
  [[nodiscard]] LightFlash flash_of(const Scene& scene, std::size_t light, const Entry& entry,
                                    const Bundle& bundle) const;
  void put(const Scene& scene, std::size_t light, const Entry& entry, const BoundingSphere& sphere,
           LampTable& table, int j) const;

  const SheetKernels* kernels_;
  const Hub* hub_;
  std::vector<Entry> entries_;
  std::vector<LaneBall> balls_;
  std::vector<Numbered> numbered_;
  struct Group {
    bool singly, moves;
  };
  std::vector<Group> groups_;
  bool lamps_move_ = false;
  std::vector<EyeView> eyes_;
  std::vector<LampView> lamps_;
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
