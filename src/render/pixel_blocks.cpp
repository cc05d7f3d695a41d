#include "pixel_blocks.h"

#include <cstring>

namespace backlight {
namespace {

bool is_untouched(const std::uint8_t* done, int width) {
  std::uint64_t any = 0;
  for (int row = 0; row < block_size; ++row) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, done + row * width, sizeof eight);
    any |= eight;
  }
  return any == 0;
}

}  // namespace

std::size_t MissingPixels::add_block(const PixelBox& tile, int left, int top, const std::uint8_t* done,
                                     int width, std::size_t first) {
  const bool inside = left + block_size <= tile.x1 && top + block_size <= tile.y1;
  TilePixel* next = pixels.data() + first;
  if (inside && is_untouched(done, width)) {
    whole.push_back(first);
    for (const auto [right, down] : block_order) *next++ = {left + right, top + down};
    return first + block_pixels;
  }
  for (const auto [right, down] : block_order) {
    const int x = left + right;
    const int y = top + down;
    if (x < tile.x1 && y < tile.y1 && done[down * width + right] == 0) *next++ = {x, y};
  }
  return static_cast<std::size_t>(next - pixels.data());
}

void MissingPixels::list(const PixelBox& tile, const PixelBox& window, const std::uint8_t* done) {
  // As many as the tile has, and not cleared first.
  pixels.resize(static_cast<std::size_t>(tile.width()) * static_cast<std::size_t>(tile.height()));
  whole.clear();
  std::size_t count = 0;
  const int width = window.width();
  for (int top = tile.y0; top < tile.y1; top += block_size) {
    for (int left = tile.x0; left < tile.x1; left += block_size) {
      const std::ptrdiff_t at = std::ptrdiff_t{top - window.y0} * width + (left - window.x0);
      count = add_block(tile, left, top, done + at, width, count);
    }
  }
  pixels.resize(count);
}

}  // namespace backlight
