// Where in a pixel its samples lie.
#pragma once

#include <cstdint>

#include "backlight/camera/projection.h"
#include "backlight/camera/sample_digits.h"

namespace backlight {

/// What a sample's position depends on, and nothing else: never the thread, the tile or the crop.
struct SampleKey {
  std::uint64_t seed = 0;
  std::int64_t image = 0;  ///< number of the image in its animation
  int x = 0;               ///< pixel of the full image
  int y = 0;
  int part = 0;  ///< of a pixel whose parts have samples of their own; 0: the whole
};

/// The position of sample `index` of `count` in the pixel of `key`. One sample is exactly the pixel's
/// centre; more are Sobol's sequence in two dimensions (1967), scrambled anew for each key by nested
/// permutations of its digits (Owen 1995), which are those of a hash (Laine and Karras 2011, section 3.1;
/// Burley 2020). The first 2^k samples are one in each of 2^k equal rectangles, for every shape that
/// 2^i × 2^(k - i) of them can have: any first ones are spread evenly. The first 2^32 are different.
ImagePoint sample_point(const SampleKey& key, int index, int count);

SampleRow sample_row(std::uint64_t seed, std::int64_t image, int index);

/// The same in the unit square, whatever the count.
ImagePoint unit_sample(const SampleKey& key, int index);

}  // namespace backlight
