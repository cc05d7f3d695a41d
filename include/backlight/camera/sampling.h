// Where in a pixel its samples lie.
#pragma once

#include <cstdint>

#include "backlight/camera/projection.h"

namespace backlight {

/// What a sample's position depends on, and nothing else: never the thread, the tile or the crop.
struct SampleKey {
  std::uint64_t seed = 0;
  std::int64_t image = 0;  ///< number of the image in its animation
  int x = 0;               ///< pixel of the full image
  int y = 0;
};

/// The position of sample `index` of `count` in the pixel of `key`. One sample is exactly the pixel's
/// centre; more follow Roberts' additive recurrence R2 (a low-discrepancy sequence), shifted in each pixel by
/// a hash of its key.
ImagePoint sample_point(const SampleKey& key, int index, int count);

}  // namespace backlight
