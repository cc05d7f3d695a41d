#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include "backlight/film/display.h"
#include "backlight/film/exr.h"
#include "commands.h"
#include "exit_codes.h"
#include "messages.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

// Pictures in rows, left to right and top to bottom, each at the top left of a cell of the largest one's
// size.
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

fs::path output_path(const ViewOptions& options) {
  if (!options.output.empty()) return options.output;
  return fs::path(options.files.front()).replace_extension(".png");
}

void print_report(const fs::path& file, const DisplayReport& report) {
  const auto tell = [&file](std::size_t pixels, const std::string& what) {
    if (pixels == 0) return;
    std::cerr << file.string() << ": " << pixels << (pixels == 1 ? " pixel " : " pixels ") << what << '\n';
  };
  tell(report.beyond_white, "beyond white");
  tell(report.outside_gamut, "outside the screen's colours");
  tell(report.not_a_number, "not a number, shown magenta");
}

}  // namespace

int run(const ViewOptions& options) {
  const fs::path output = output_path(options);
  if (output.extension() != ".png") {
    print_error("--output: a view is written as PNG: '" + output.string() + "' must end in .png");
    return exit_usage;
  }
  std::vector<PixelBytes> pictures;
  for (const fs::path& file : options.files) {
    const auto picture = read_exr(file);
    if (!picture.ok()) {
      print_error(picture.error());
      return exit_file_trouble;
    }
    auto displayed = display_image(picture.value().image, options.transform, options.view);
    if (!displayed.ok()) {
      print_error(file.string() + ": " + displayed.error());
      return exit_file_trouble;
    }
    if (options.verbosity != Verbosity::quiet) print_report(file, displayed.value().report);
    pictures.push_back(std::move(displayed.value().pixels));
  }
  const PixelBytes sheet =
      pictures.size() == 1 ? std::move(pictures.front()) : contact_sheet(pictures, options.columns);
  const auto written = write_png(output, sheet);
  if (!written.ok()) {
    print_error(written.error());
    return exit_file_trouble;
  }
  return exit_success;
}

}  // namespace backlight
