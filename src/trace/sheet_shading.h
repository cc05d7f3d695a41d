// Light on the points of a sheet: what illumination.cpp and shading.cpp do for one.
#pragma once

#include <cstdint>
#include <span>

#include "leg.h"
#include "shading_steps.h"
#include "shadow_packets.h"
#include "sheet_scene.h"

namespace backlight {

/// A ray that a mirror passes on, until it goes in a sheet with others.
struct PutOff {
  Leg leg;
  int frame;  ///< of the relay
  const Effects* effects;
  std::size_t place;  ///< that of the ray which met the mirror
};

/// Working memory of one thread, besides Scratch.
struct SheetScratch {
  SheetScratch(const SheetScene& scene, std::size_t lights, InstructionSet set);

  struct TileSheet {
    SheetRays rays;
    SheetHits hits;
    const Effects* effects = nullptr;
    Bundle bundle;
    int place[sheet_size];  ///< index of the pixel in the tile
  };
  std::vector<PutOff> legs;             ///< by place, of rays that a mirror passed on; empty of a camera's
  std::vector<PutOff> put_off;          ///< the rays that mirrors pass on from these
  std::span<TileSheet> sheets;          ///< those in use...
  std::vector<TileSheet> sheet_memory;  ///< ...of these, which are not cleared between tiles
  RaySheet rays;                        ///< of one sheet in one frame
  std::vector<FirstHit> far_hits;       ///< by place: of frames that take one ray at a time
  ConeStore tile_cones;                 ///< what the whole tile may meet
  ConeStore sheet_cones;                ///< what one sheet may meet
  static constexpr int not_listed = -1;
  std::vector<LampStore>
      tile_lamps;  ///< by light: what may shade any of the tile's hits; count: or not_listed
  std::vector<ShadowPackets> packets;   ///< by light
  std::vector<LaneLamp> lane_lamps;     ///< by light, as last seen from a frame of the tile
  std::vector<LampStore> packet_lamps;  ///< what may shade any of a packet of shadow rays, and of its parts
  LampStore chunk_lamps;                ///< what may shade any of the points of a sheet...
  LampStore near_lamps;                 ///< ...and a few of them
  std::vector<int> travellers;          ///< entries to be narrowed
  std::vector<PassingBall> passings;    ///< by entry: what the light of a sheet meets of those
  // Hits sorted by the group of what was hit (Numbered):
  struct Group {
    std::size_t key;
    int count;  ///< of parts
    int next;
  };
  /// Those of a sheet's lanes that hit the same.
  struct Part {
    int group;
    int sheet;
    int surface;  ///< its number
    std::uint64_t mask;
  };
  std::vector<int> group_of;  ///< by key: index of its group, or -1
  std::vector<Group> groups;
  std::vector<Part> parts;   ///< as found...
  std::vector<Part> sorted;  ///< ...and by group
  PointSheet points;
  /// Reflectances of points of a texture, one bit for each that is known.
  std::uint64_t known_texels;
  std::vector<Spectrum> texels;
  std::vector<SeenSpectrum> seen_texels;
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
  void collect();
  void sift_packets();

  /// The points are now others.
  void begin_points();

  /// Whether lanes can light the points; else they are left to the law.
  [[nodiscard]] bool in_lanes() const {
    return sheets_.lit_in_lanes(entry_->frame, *effects_) &&
           !sheets_.goes_singly(sheets_.numbered(work_.points.runs[0].surface).group);
  }

  /// Finds the points themselves. False: they are of several materials, as of a solid's members.
  bool resolve();

  /// Whether the matter of a point that was found is too fast for lanes in its frame.
  [[nodiscard]] bool is_too_fast() const { return too_fast_; }

  /// The colours of work.points, of one material, into points.rgb.
  void shade(const Effects& effects);

  /// The sky's colours along the rays whose bits are set, into points.rgb.
  void shade_sky(const SheetRays& rays, std::uint64_t lanes, const Effects& effects);

  /// What the ray of a lane of work.points meets.
  [[nodiscard]] FirstHit hit(int lane) const;

  /// The camera ray of a lane of work.points.
  [[nodiscard]] CameraRay camera_ray_of(int lane) const;

 private:
  [[nodiscard]] const BrightnessSwitches& towards_camera(const Effects& effects) const;
  [[nodiscard]] const LaneLamp& lane_lamp(std::size_t light, int frame) const;
  void fill_shading_normals(const SurfaceSet& surfaces);
  bool find_celerities();
  void fill_strength(const Light& light);
  void fill_diffuse(std::size_t light, int material, LaneReflection& reflection);
  // Shadows (tile_shadows.cpp):
  const LampTable& occluders_of_tile(std::size_t light);
  void list_for_tile(std::size_t light, LampTable& list) const;
  [[nodiscard]] bool narrows(std::size_t light) const;
  void narrow_travellers(std::size_t light, const Bundle& bundle, LampTable& list) const;
  [[nodiscard]] bool in_packets(std::size_t light) const;
  void shadow(std::size_t light);
  void shadow_by_packets(std::size_t light);
  void sift(std::size_t light, const LampTable& near, double time, int first, int last);
  void try_entry(std::size_t light, int index, std::uint64_t candidates, const PassingBall& passing = {});
  void try_extended(std::size_t light, int frame, std::uint64_t candidates);
  [[nodiscard]] bool is_alone(int entry) const;
  void shadow_of_distant(std::size_t light);

  void ambient_arrives(std::size_t light);
  bool light_arrives(std::size_t light, const Effects& effects, const Material& material,
                     LaneReflection& reflection);
  // Shifted colours (sheet_spectra.cpp):
  void fill_emission(int material);
  void fill_shifted(std::size_t light, int material, LaneReflection& reflection);
  [[nodiscard]] std::uint64_t look_up(std::size_t light, int material, std::uint64_t points, bool has_lobe);
  LampColours colours_at(int lane, std::size_t light, int material);
  /// One bit each.
  [[nodiscard]] std::uint64_t lit_points() const {
    return sheets_.kernels().same(work_.points.lit, work_.points.count, 1.0);
  }
  [[nodiscard]] std::size_t frame() const { return static_cast<std::size_t>(entry_->frame); }

  const Tracer& tracer_;
  const SheetScene& sheets_;
  int eye_;
  SheetScratch& work_;
  Scratch& scratch_;
  const Entry* entry_ = nullptr;  // of whose frame the points are
  int sheet_ = -1;                // their number in the tile
  const Effects* effects_ = nullptr;
  bool too_fast_ = false;
};

LaneBrightness lane_brightness(const BrightnessSwitches& on);

}  // namespace backlight
