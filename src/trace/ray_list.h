// Some of a sheet's rays, in one frame, for a surface that is asked about many rays at once.
#pragma once

#include <cstddef>

#include "backlight/surface/surface_set.h"
#include "sheet.h"

namespace backlight {

class RayList {
 public:
  void add(int lane, const Vec3& origin, const Vec3& direction, const RayClock& clock) {
    for (int k = 0; k < 3; ++k) {
      origin_[k][count_] = origin[k];
      direction_[k][count_] = direction[k];
    }
    time_[count_] = clock.start;
    rate_[count_] = clock.rate;
    lane_[count_++] = lane;
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] int lane(std::size_t i) const { return lane_[i]; }
  [[nodiscard]] SurfaceSet::Rays rays() const {
    return {count_,
            {origin_[0], origin_[1], origin_[2]},
            {direction_[0], direction_[1], direction_[2]},
            time_,
            rate_};
  }

 private:
  std::size_t count_ = 0;
  double origin_[3][sheet_size];
  double direction_[3][sheet_size];
  double time_[sheet_size];
  double rate_[sheet_size];
  int lane_[sheet_size];
};

}  // namespace backlight
