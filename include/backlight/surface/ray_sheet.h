// Up to 64 rays in one rest frame, as arrays: what a SurfaceSet is asked about at once, and what it answers.
#pragma once

#include <cstdint>
#include <limits>

#include "backlight/base/instruction_sets.h"

namespace backlight {

inline constexpr int sheet_size = 64;  ///< rays: of 8x8 pixels

/// Rays x(λ) = origin + λ direction, and the frame's time along them, start_time + λ time_rate.
struct RaySheet {
  /// How many there are, rounded up to whole registers of any width; the spare ones do what the last one
  /// does.
  int padded = 0;
  /// Whether the first one's origin and start_time are those of all.
  bool one_origin = false;
  InstructionSet instructions = InstructionSet::widest;
  alignas(64) double origin[3][sheet_size];
  alignas(64) double direction[3][sheet_size];
  alignas(64) double length[sheet_size];  ///< of `direction`, to within rounding
  alignas(64) double start_time[sheet_size];
  alignas(64) double time_rate[sheet_size];
};

/// A ball that goes straight on, which holds another one on a path while light meets it that arrives at or
/// leaves an event, or others next to it. To begin with, it is not known.
struct PassingBall {
  double centre[3]{};  ///< at `time`
  double velocity[3]{};
  double time = 0.0;
  double radius = std::numeric_limits<double>::infinity();
};

/// Where rays meet something first; to begin with, nowhere.
struct SheetHits {
  alignas(64) double lambda[sheet_size];  ///< infinite, or as far as is looked
  alignas(64) double who[sheet_size];     ///< the surface's number (exact as a double), or -1
  alignas(64) double along[sheet_size];   ///< Hit::along
  alignas(64) double part[sheet_size];    ///< Hit::part, or -1 - part of an unresolved root

  void clear(int count) {
    for (int i = 0; i < count; ++i) {
      lambda[i] = std::numeric_limits<double>::infinity();
      who[i] = -1.0;
    }
  }
  [[nodiscard]] int part_of(int ray) const {
    return static_cast<int>(part[ray] < 0.0 ? -1.0 - part[ray] : part[ray]);
  }
  [[nodiscard]] bool is_unresolved(int ray) const { return part[ray] < 0.0; }
};

/// The points of hits: SurfacePoint.
struct SheetPoints {
  alignas(64) double position[3][sheet_size];
  alignas(64) double normal[3][sheet_size];
  alignas(64) double shading_normal[3][sheet_size];  ///< not set unless SurfaceSet::is_smooth()
  alignas(64) double error_bound[sheet_size];
  alignas(64) double u[sheet_size];
  alignas(64) double v[sheet_size];
  int member[sheet_size];  ///< not set where a surface has but one
  /// Not set of surfaces that cannot move (SurfaceSet::moves()).
  double velocity[3][sheet_size];
  double own_time[sheet_size];
};

}  // namespace backlight
