#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>

#include "backlight/film/display.h"
#include "backlight/film/exposure.h"
#include "backlight/film/exr.h"
#include "backlight/film/why_black.h"
#include "commands.h"
#include "display_words.h"
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

// Each image in a PNG of its own, in a folder; otherwise all of them in one PNG.
bool goes_to_folder(const ViewOptions& options) {
  std::error_code error;
  return !options.output.empty() &&
         (options.output.filename().empty() || fs::is_directory(options.output, error));
}

fs::path output_path(const ViewOptions& options, const fs::path& file) {
  const fs::path name = fs::path(file).replace_extension(".png");
  if (options.output.empty()) return name;
  return goes_to_folder(options) ? options.output / name.filename() : options.output;
}

// The first part that has the colour of this view; else the first.
std::size_t part_to_show(const std::vector<ExrInfo>& parts, std::size_t view) {
  const auto has_colour = [view](const ExrInfo& part) {
    const ImageLayout& layout = part.layout;
    return part.unreadable.empty() && std::ranges::all_of(std::array{"R", "G", "B"}, [&](const char* name) {
             return std::ranges::find(layout.channels, channel_name(name, layout.views, view),
                                      &ChannelInfo::name) != layout.channels.end();
           });
  };
  const auto found = std::ranges::find_if(parts, has_colour);
  return found == parts.end() ? 0 : static_cast<std::size_t>(found - parts.begin());
}

Result<ExrPicture> read_shown(const fs::path& file, std::size_t view) {
  const auto parts = read_exr_parts(file);
  if (!parts.ok()) return parts.failure();
  return read_exr(file, part_to_show(parts.value(), view));
}

// One transform for all the images, so that they can be compared, and a film does not flicker.
Result<DisplayTransform> transform_of(const ViewOptions& options) {
  const bool automatic = options.display.is_automatic();
  LuminanceCounts counts;
  for (const fs::path& file : automatic ? options.files : std::vector<fs::path>{}) {
    const auto picture = read_shown(file, options.view);
    if (!picture.ok()) return picture.failure();
    if (const auto added = counts.add(picture.value().image, options.view); !added.ok()) {
      return Failure{file.string() + ": " + added.error()};
    }
  }
  const DisplayTransform transform = options.display.transform(counts);
  const std::string words = automatic ? words_of(transform) : std::string();
  if (!words.empty() && options.verbosity != Verbosity::quiet) std::cerr << words << '\n';
  return transform;
}

// A strip of the reasons' colours below the picture, in their order, and a line for each on stdout.
void add_legend(PixelBytes& pixels, const fs::path& file, const BlackCounts& counts) {
  const auto width = static_cast<std::size_t>(pixels.width);
  const int strip = std::max(4, pixels.height / 32);
  const std::size_t total = width * static_cast<std::size_t>(pixels.height);
  for (int y = 0; y < strip; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const auto& colour = black_reasons()[x * why_black_count / width].colour;
      pixels.samples.insert(pixels.samples.end(), colour.begin(), colour.end());
    }
  }
  pixels.height += strip;
  std::cout << file.string() << ": black because\n";
  for (std::size_t i = 0; i < why_black_count; ++i) {
    std::cout << "  " << std::left << std::setw(28) << black_reasons()[i].name << std::setw(8)
              << black_reasons()[i].colour_name << std::right << std::setw(9) << counts[i] << " pixels  "
              << std::fixed << std::setprecision(1) << 100.0 * double(counts[i]) / double(total) << " %\n";
  }
}

// What of the file the picture does not show, beside its data channels.
void print_rest(const fs::path& file, std::size_t view) {
  const auto parts = read_exr_parts(file);
  if (!parts.ok()) return;
  const ExrInfo& part = parts.value()[part_to_show(parts.value(), view)];
  if (part.parts > 1) {
    std::cerr << file.string() << ": of " << part.parts << " parts, '" << part.part << "' is shown\n";
  }
  if (part.pixel_aspect != 1.0F) {
    std::cerr << file.string() << ": shown with square pixels; the file has them "
              << text_of(part.pixel_aspect) << " times as wide as high\n";
  }
}

Result<PixelBytes> shown(const fs::path& file, const ViewOptions& options,
                         const DisplayTransform& transform) {
  const auto picture = read_shown(file, options.view);
  if (!picture.ok()) return picture.failure();
  if (options.verbosity != Verbosity::quiet) print_rest(file, options.view);
  auto displayed = display_image(picture.value().image, transform, options.view);
  if (!displayed.ok()) return Failure{file.string() + ": " + displayed.error()};
  if (options.verbosity != Verbosity::quiet && transform.tone == ToneCurve::none) {
    for (const std::string& line : lines_of(displayed.value().report))
      std::cerr << file.string() << ": " << line << '\n';
  }
  PixelBytes pixels = std::move(displayed.value().pixels);
  if (options.why) {
    const auto counts = mark_black(pixels, picture.value().image, transform, options.view);
    if (!counts.ok()) return Failure{file.string() + ": " + counts.error()};
    add_legend(pixels, file, counts.value());
  }
  return pixels;
}

int file_trouble(const std::string& message) {
  print_error(message);
  return exit_file_trouble;
}

}  // namespace

int run(const ViewOptions& options) {
  const bool each = goes_to_folder(options);
  const fs::path output = output_path(options, options.files.front());
  if (output.extension() != ".png") {
    print_error("--output: a view is written as PNG: '" + output.string() +
                "' must end in .png, or in / for a folder");
    return exit_usage;
  }
  const auto transform = transform_of(options);
  if (!transform.ok()) return file_trouble(transform.error());
  std::vector<PixelBytes> pictures;
  for (const fs::path& file : options.files) {
    auto pixels = shown(file, options, transform.value());
    if (!pixels.ok()) return file_trouble(pixels.error());
    if (!each) {
      pictures.push_back(std::move(pixels).value());
    } else if (const auto written = write_png(output_path(options, file), pixels.value()); !written.ok()) {
      return file_trouble(written.error());
    }
  }
  if (each) return exit_success;
  const PixelBytes sheet =
      pictures.size() == 1 ? std::move(pictures.front()) : contact_sheet(pictures, options.columns);
  const auto written = write_png(output, sheet);
  return written.ok() ? static_cast<int>(exit_success) : file_trouble(written.error());
}

}  // namespace backlight
