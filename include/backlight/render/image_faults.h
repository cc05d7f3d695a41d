// What is wrong with the numbers of an image.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "backlight/film/image.h"

namespace backlight {

struct ImageFaults {
  /// Pixels with a NaN or an infinity in any channel, but for a Z of +infinity: nothing is there.
  std::uint64_t non_finite = 0;
  std::optional<std::pair<int, int>> first_non_finite;  ///< the first of them (x, y), row by row
  std::uint64_t saturated =
      0;  ///< pixels with a colour channel at the greatest float, where brighter ones end
  std::uint64_t beyond_half = 0;  ///< pixels with a finite value of a half channel that half cannot hold

  /// Of other pixels of the same image.
  ImageFaults& operator+=(const ImageFaults& other);
};

/// Looks at every pixel. Those of a stereo pair count once.
ImageFaults faults_of(const Image& image);

}  // namespace backlight
