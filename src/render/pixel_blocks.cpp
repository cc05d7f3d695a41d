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

void MissingPixels::add_block(const PixelBox& tile, int left, int top, const std::uint8_t* done, int width) {
  const bool inside = left + block_size <= tile.x1 && top + block_size <= tile.y1;
  const std::size_t first = pixels.size();
  if (inside && is_untouched(done, width)) {
    whole.push_back(first);
    pixels.resize(first + block_pixels);
    for (std::size_t i = 0; i < block_pixels; ++i) {
      pixels[first + i] = {left + block_order[i].right, top + block_order[i].down};
    }
    return;
  }
  for (const auto [right, down] : block_order) {
    const int x = left + right;
    const int y = top + down;
    if (x < tile.x1 && y < tile.y1 && done[down * width + right] == 0) pixels.push_back({x, y});
  }
}

void MissingPixels::list(const PixelBox& tile, const ImageLayout& layout, const std::uint8_t* done) {
  pixels.clear();
  whole.clear();
  const PixelBox& window = layout.data;
  const int width = window.width();
  for (int top = tile.y0; top < tile.y1; top += block_size) {
    for (int left = tile.x0; left < tile.x1; left += block_size) {
      const std::ptrdiff_t at = std::ptrdiff_t{top - window.y0} * width + (left - window.x0);
      add_block(tile, left, top, done + at, width);
    }
  }
}

}  // namespace backlight
