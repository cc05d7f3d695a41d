// The order in which a tile's pixels are traced: in squares of a sheet of rays each, and those within them in
// squares within squares, so that neighbours in this order are neighbours in the image.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "backlight/film/image.h"
#include "backlight/trace/sheet_tracer.h"

namespace backlight {

inline constexpr int block_size = 8;
inline constexpr std::size_t block_pixels = 64;

struct BlockPlace {
  int right;
  int down;
};

inline constexpr auto block_order = [] {
  std::array<BlockPlace, block_pixels> order{};
  for (unsigned i = 0; i < order.size(); ++i) {
    order[i] = {static_cast<int>((i & 1U) | ((i >> 1U) & 2U) | ((i >> 2U) & 4U)),
                static_cast<int>(((i >> 1U) & 1U) | ((i >> 2U) & 2U) | ((i >> 3U) & 4U))};
  }
  return order;
}();

/// The pixels of a tile that are still to be traced.
struct MissingPixels {
  std::vector<TilePixel> pixels;
  std::vector<std::size_t> whole;  ///< where the blocks of which no pixel is done begin

  /// `done`: a byte for each pixel of `window`, which the tile lies in.
  void list(const PixelBox& tile, const PixelBox& window, const std::uint8_t* done);

 private:
  std::size_t add_block(const PixelBox& tile, int left, int top, const std::uint8_t* done, int width,
                        std::size_t first);
};

}  // namespace backlight
