#include "picture_layout.h"

#include <algorithm>
#include <cmath>

#include "backlight/film/lettering.h"

namespace backlight {

PixelBytes contact_sheet(const std::vector<PixelBytes>& pictures, int columns) {
  int cell_width = 0;
  int cell_height = 0;
  for (const PixelBytes& picture : pictures) {
    cell_width = std::max(cell_width, picture.width);
    cell_height = std::max(cell_height, picture.height);
  }
  const auto count = static_cast<int>(pictures.size());
  columns = std::clamp(columns > 0 ? columns : static_cast<int>(std::ceil(std::sqrt(count))), 1, count);
  const int rows = (count + columns - 1) / columns;
  PixelBytes sheet{cell_width * columns, cell_height * rows, 3, {}};
  const auto row_bytes = static_cast<std::size_t>(sheet.width) * 3;
  sheet.samples.assign(row_bytes * static_cast<std::size_t>(sheet.height), 0);
  for (int i = 0; i < count; ++i) {
    const PixelBytes& picture = pictures[static_cast<std::size_t>(i)];
    const auto picture_row = static_cast<std::ptrdiff_t>(picture.width) * 3;
    for (int y = 0; y < picture.height; ++y) {
      const auto from = picture.samples.begin() + y * picture_row;
      const auto row = static_cast<std::size_t>(i / columns * cell_height + y);
      const auto column = static_cast<std::size_t>(i % columns * cell_width) * 3;
      std::copy(from, from + picture_row,
                sheet.samples.begin() + static_cast<std::ptrdiff_t>(row * row_bytes + column));
    }
  }
  return sheet;
}

Result<void> add_label(PixelBytes& pixels, int height, const std::string& text) {
  const int size = fitting_size(text, pixels.width - 8, std::clamp(height / 20, 12, 32));
  const int strip = std::min(size + size / 2, height);
  const auto row = std::ptrdiff_t{3} * pixels.width;
  const auto begin = pixels.samples.begin() + (height - strip) * row;
  std::transform(begin, begin + strip * row, begin,
                 [](std::uint8_t sample) { return static_cast<std::uint8_t>(sample / 3); });
  return write_text(pixels, {text, size / 3 + 1, height - size / 2, TextSide::left, size});
}

}  // namespace backlight
