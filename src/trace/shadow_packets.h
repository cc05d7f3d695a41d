// The shadow rays of a tile's lit hits, whatever surfaces they are of, in packets of neighbours: sorted by
// the light's direction and its time of emission, so that the occluders of a packet are few.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sheet_scene.h"

namespace backlight {

/// With more occluders than this near some shadow rays, parts of them have lists of their own...
inline constexpr int few_occluders = 4;
/// ...down to so many neighbouring rays.
inline constexpr int few = 16;

/// Those of one light and one tile. Sheets of points are told by their number in the order of painting.
class ShadowPackets {
 public:
  /// Rays of a sheet that it is left to the law to decide about, one bit each.
  struct Unclear {
    int sheet;
    int who;  ///< occluder
    std::uint64_t rays;
  };
  void clear();

  /// Adds the rays of the lit points. `own`: the occluder that their surface is, or -1: never tried here.
  void add(const PointSheet& points, int sheet, int own);

  /// Finds which of them the listed occluders shade for sure, and which they may.
  /// `lists`: room for those of a packet, of its parts, of their parts...
  void sift(const SheetKernels& kernels, const LampTable& occluders, std::span<LampStore> lists);

  [[nodiscard]] bool has(int sheet) const;
  /// The rays of a sheet that are surely shaded, one bit each.
  [[nodiscard]] std::uint64_t shaded(int sheet) const { return shaded_[static_cast<std::size_t>(sheet)]; }
  /// Those of a sheet that are unclear.
  [[nodiscard]] std::span<const Unclear> unclear(int sheet) const;

 private:
  enum Column : std::size_t { way_length = 3, moment = 4, lit = 5 };

  /// Neighbours on one surface, at the beginning of a register.
  struct Run {
    std::uint32_t key = 0;
    std::uint32_t first = 0;  ///< of the rays
    std::int32_t count = 0;
    std::int32_t sheet = 0;
    std::int32_t own = 0;
  };
  /// Columns with room for a register behind the last ray.
  struct Rays {
    std::array<std::vector<double>, 6> column;  ///< way, its length, time of emission, 1 where lit
    std::vector<std::uint8_t> lane;             ///< of the sheet
    std::size_t count = 0;
    void make_room(std::size_t more);
    [[nodiscard]] LightRays view(std::size_t first);
  };

  void close_run(Run& run);
  void make_keys();
  void sort();
  [[nodiscard]] std::size_t cut(std::size_t first, std::size_t last) const;
  void sift_packet(const SheetKernels& kernels, const LampTable& from, std::size_t first, std::size_t last,
                   std::span<LampStore> lists);
  const LampTable* list(const SheetKernels& kernels, const LampTable& from, std::size_t first_run,
                        std::size_t last_run, LampTable& to, double& time);
  void sift_run(const SheetKernels& kernels, const LampTable& near, double time, const Run& run);
  void note(const Run& run, std::uint64_t rays, int who);

  Rays found_;  ///< in the order of painting
  Rays rays_;   ///< in that of the runs
  std::vector<Run> runs_;
  std::vector<Vec3> places_;           ///< of runs, by what their keys are made from
  std::vector<std::uint64_t> shaded_;  ///< by sheet
  std::vector<std::uint8_t> has_;      ///< by sheet
  std::vector<Unclear> unclear_;       ///< by sheet
};

}  // namespace backlight
