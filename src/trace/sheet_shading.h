// Light on the points of a sheet: what illumination.cpp and shading.cpp do for one.
#pragma once

#include <cstdint>
#include <span>

#include "shading_steps.h"
#include "shadow_packets.h"
#include "sheet_scene.h"

namespace backlight {

/// Working memory of one thread, besides Scratch.
struct SheetScratch {
  explicit SheetScratch(const SheetScene& scene, std::size_t lights);

  struct TileSheet {
    SheetRays rays;
    const Effects* effects = nullptr;
    Bundle bundle;
    int place[sheet_size];        ///< index of the pixel in the tile
    int part[sheet_size];         ///< face, of surfaces that take one ray at a time
    bool unresolved[sheet_size];  ///< and whether its root was isolated
    double along[sheet_size];     ///< Hit::along
  };
  std::span<TileSheet> sheets;          ///< those in use...
  std::vector<TileSheet> sheet_memory;  ///< ...of these, which are not cleared between tiles
  std::vector<FirstHit> far_hits;       ///< by place: of frames that take one ray at a time
  ConeStore tile_cones;                 ///< what the whole tile may meet
  ConeStore sheet_cones;                ///< what one sheet may meet
  static constexpr int not_listed = -1;
  std::vector<LampStore>
      tile_lamps;  ///< by light: what may shade any of the tile's hits; count: or not_listed
  std::vector<ShadowPackets> packets;   ///< by light
  std::vector<LampStore> packet_lamps;  ///< what may shade any of a packet of shadow rays, and of its parts
  LampStore chunk_lamps;                ///< what may shade any of the points of a sheet...
  LampStore near_lamps;                 ///< ...and a few of them
  // Hits sorted by what was hit:
  struct Group {
    int who;
    int count;  ///< of parts
    int next;
  };
  /// Those of a sheet's lanes that hit the same.
  struct Part {
    int group;
    int sheet;
    std::uint64_t mask;
  };
  std::vector<int> group_of;  ///< by occupant: index of its group, or -1
  std::vector<Group> groups;
  std::vector<Part> parts;   ///< as found...
  std::vector<Part> sorted;  ///< ...and by group
  Hit hits[sheet_size];      ///< of the points; in lanes, only from SheetShader::hit() on
  PointSheet points;
  /// What of a lamp reaches them, for spectra.
  struct Lamp {
    bool arrives;
    double lit[sheet_size];
    double irradiance[sheet_size];
    double specular[sheet_size];
    double doppler[sheet_size];
    bool known;  ///< `colours` are those that the lamp has on the points, at this Doppler factor
    double known_doppler;
    LampColours colours;
  };
  std::vector<Lamp> lamp_light;
};

/// Shades sheets of points of one image.
class SheetShader {
 public:
  SheetShader(const Tracer& tracer, const SheetScene& sheets, int eye, SheetScratch& work, Scratch& scratch)
      : tracer_(tracer), sheets_(sheets), eye_(eye), work_(work), scratch_(scratch) {}

  /// The sheets to come are those with these effects.
  void begin_tile(const Effects& effects);

  /// Whether shadow rays are sorted into packets: then all points have to come twice in the same order, for
  /// collect() and, after sift_packets(), for shade().
  [[nodiscard]] bool wants_packets() const;
  void collect(const Occupant& occupant);
  void sift_packets();

  /// The points are now others, of this surface.
  void begin_points(const Occupant& occupant);

  /// The colours of work.points, of one surface, into points.rgb. False where they are of several materials:
  /// then the points are known, but not the colours.
  bool shade(const Occupant& occupant, const Effects& effects);

  /// What the ray of a lane of work.points meets.
  [[nodiscard]] FirstHit hit(int lane);

  /// The camera ray of a lane of work.points.
  [[nodiscard]] CameraRay camera_ray_of(int lane) const;

 private:
  int resolve(const Occupant& occupant);
  int resolve_one_by_one(const Occupant& occupant);
  [[nodiscard]] LaneLamp lane_lamp(std::size_t light, int frame) const;
  void fill_strength(const Light& light, std::size_t index);
  void fill_diffuse(std::size_t light, int material, LaneReflection& reflection);
  const LampTable& occluders_of_tile(std::size_t light);
  void list_for_tile(std::size_t light, LampTable& list) const;
  [[nodiscard]] bool in_packets(std::size_t light) const;
  void shadow(std::size_t light);
  void shadow_by_packets(std::size_t light);
  void sift(std::size_t light, const LampTable& near, double time, int first, int last);
  void try_occluder(std::size_t light, const Occupant& occluder, std::uint64_t candidates);
  void try_one_by_one(std::size_t light, const Occupant& occluder);
  [[nodiscard]] std::uint64_t shaded_by_itself() const;
  [[nodiscard]] bool is_own(const Occupant& occluder) const;
  void shadow_of_distant(std::size_t light);
  void light_rgb(const Material& material, int material_index, const Effects& effects);
  bool light_reaches(std::size_t light, const Effects& effects, const Material& material,
                     LaneReflection& reflection);
  void ambient_arrives(std::size_t light);
  bool light_arrives(std::size_t light, const Effects& effects, const Material& material,
                     LaneReflection& reflection);
  void light_spectra(const Material& material, int material_index, const Effects& effects);
  [[nodiscard]] std::size_t frame() const { return static_cast<std::size_t>(occupant_->frame); }

  const Tracer& tracer_;
  const SheetScene& sheets_;
  int eye_;
  SheetScratch& work_;
  Scratch& scratch_;
  const Occupant* occupant_ = nullptr;  // whose points they are
  int sheet_ = -1;                      // their number in the tile
  const Effects* effects_ = nullptr;
  bool hits_known_ = false;
};

LaneBrightness lane_brightness(const BrightnessSwitches& on);

}  // namespace backlight
