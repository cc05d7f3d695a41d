#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>
#include <tuple>

#include "backlight/film/display.h"
#include "backlight/film/exposure.h"
#include "backlight/film/exr.h"
#include "backlight/film/why_black.h"
#include "channel_view.h"
#include "commands.h"
#include "cube_faces.h"
#include "display_words.h"
#include "exit_codes.h"
#include "label_text.h"
#include "messages.h"
#include "picture_layout.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

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
    const auto picture = read_shown(file, options.views.front());
    if (!picture.ok()) return picture.failure();
    for (const std::size_t view : options.views) {
      if (const auto added = counts.add(picture.value().image, view); !added.ok())
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

// One scale for all the images.
Result<ColourScale> scale_of(const ViewOptions& options) {
  ChannelValues values;
  std::string name;
  for (const fs::path& file : options.files) {
    const auto picture = read_exr(file);
    if (!picture.ok()) return picture.failure();
    const ImageLayout& layout = picture.value().image.layout();
    for (const std::size_t view : options.views) {
      const auto channel = channel_meant(layout, options.channel, view);
      if (!channel.ok()) return Failure{file.string() + ": " + channel.error()};
      values.add(picture.value().image, channel.value(), view);
      name = plain_name(layout.channels[channel.value()].name, layout.views, view).value_or("");
    }
  }
  if (values.empty() && options.verbosity != Verbosity::quiet)
    std::cerr << "no pixel has a finite value of " << name << '\n';
  ColourScale scale = values.scale_for(name);
  if (!options.range) return scale;
  std::tie(scale.least, scale.greatest) = *options.range;
  if (scale.logarithmic && !(scale.least > 0.0)) return Failure{"--range: " + name + " is greater than 0"};
  return scale;
}

Result<PixelBytes> shown_channel(const fs::path& file, const ViewOptions& options, std::size_t view,
                                 const ColourScale& scale) {
  const auto picture = read_exr(file);
  if (!picture.ok()) return picture.failure();
  const auto channel = channel_meant(picture.value().image.layout(), options.channel, view);
  if (!channel.ok()) return Failure{file.string() + ": " + channel.error()};
  return show_channel(picture.value(), channel.value(), view, scale);
}

Result<PixelBytes> shown(const fs::path& file, const ViewOptions& options, std::size_t view,
                         const DisplayTransform& transform) {
  const auto picture = read_shown(file, view);
  if (!picture.ok()) return picture.failure();
  if (options.verbosity != Verbosity::quiet) print_rest(file, view);
  auto displayed = display_image(picture.value().image, transform, view);
  if (!displayed.ok()) return Failure{file.string() + ": " + displayed.error()};
  if (options.verbosity != Verbosity::quiet && transform.tone == ToneCurve::none) {
    for (const std::string& line : lines_of(displayed.value().report))
      std::cerr << file.string() << ": " << line << '\n';
  }
  PixelBytes pixels = std::move(displayed.value().pixels);
  if (options.why) {
    const auto counts = mark_black(pixels, picture.value().image, transform, view);
    if (!counts.ok()) return Failure{file.string() + ": " + counts.error()};
    add_legend(pixels, file, counts.value());
  }
  return pixels;
}

// What makes the picture of a file and a view: all of them are to be seen with one transform, or one scale.
using Shower = std::function<Result<PixelBytes>(const fs::path&, std::size_t view)>;
Result<Shower> shower_of(const ViewOptions& options) {
  if (!options.channel.empty()) {
    const auto scale = scale_of(options);
    if (!scale.ok()) return scale.failure();
    return Shower([&options, scale = scale.value()](const fs::path& file, std::size_t view) {
      return shown_channel(file, options, view, scale);
    });
  }
  const auto transform = transform_of(options);
  if (!transform.ok()) return transform.failure();
  return Shower([&options, transform = transform.value()](const fs::path& file, std::size_t view) {
    return shown(file, options, view, transform);
  });
}

// The words of each picture, and the height of what is above its legend.
struct Labels {
  std::vector<std::string> text;
  std::vector<int> height;
  std::string wrong;  // what the images do not tell
};
Result<Labels> labels_of(const ViewOptions& options) {
  Labels labels;
  if (options.label.empty()) return labels;
  for (const fs::path& file : options.files) {
    const auto info = read_exr_info(file);
    if (!info.ok()) return info.failure();
    const auto text = label_text(options.label, file, info.value().header);
    if (!text.ok()) {
      labels.wrong = file.string() + ": " + text.error();
      return labels;
    }
    labels.text.push_back(text.value());
    labels.height.push_back(info.value().layout.data.height());
  }
  return labels;
}

// A picture of one file: its views one above the other, each with its label.
Result<PixelBytes> whole_picture(const ViewOptions& options, const Shower& show, const Labels& labels,
                                 std::size_t file) {
  std::vector<PixelBytes> views;
  for (const std::size_t view : options.views) {
    auto pixels = show(options.files[file], view);
    if (!pixels.ok()) return pixels;
    if (!options.label.empty()) {
      const auto added = add_label(pixels.value(), labels.height[file], labels.text[file]);
      if (!added.ok()) return added.failure();
    }
    views.push_back(std::move(pixels).value());
  }
  return views.size() == 1 ? std::move(views.front()) : contact_sheet(views, 1);
}

// Fails if an image has no six faces.
Result<void> require_cubemaps(const ViewOptions& options) {
  for (const fs::path& file : options.files) {
    const auto info = read_exr_info(file);
    if (!info.ok()) return info.failure();
    if (auto cube = require_cubemap(file, info.value()); !cube.ok()) return cube;
  }
  return {};
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
  const auto labels = labels_of(options);
  if (!labels.ok()) return file_trouble(labels.error());
  if (!labels.value().wrong.empty()) {
    print_error("--label: " + labels.value().wrong);
    return exit_usage;
  }
  if (const auto cubes = options.faces ? require_cubemaps(options) : Result<void>(); !cubes.ok())
    return file_trouble(cubes.error());
  const auto show = shower_of(options);
  if (!show.ok()) return file_trouble(show.error());
  std::vector<PixelBytes> pictures;
  for (std::size_t i = 0; i < options.files.size(); ++i) {
    auto pixels = whole_picture(options, show.value(), labels.value(), i);
    if (!pixels.ok()) return file_trouble(pixels.error());
    if (options.faces) {
      const fs::path png = each ? output_path(options, options.files[i])
                                : fs::path(options.files[i]).replace_extension(".png");
      if (const auto written = write_faces(png, pixels.value()); !written.ok())
        return file_trouble(written.error());
    } else if (!each) {
      pictures.push_back(std::move(pixels).value());
    } else if (const auto written = write_png(output_path(options, options.files[i]), pixels.value());
               !written.ok()) {
      return file_trouble(written.error());
    }
  }
  if (each || options.faces) return exit_success;
  const PixelBytes sheet =
      pictures.size() == 1 ? std::move(pictures.front()) : contact_sheet(pictures, options.columns);
  const auto written = write_png(output, sheet);
  return written.ok() ? static_cast<int>(exit_success) : file_trouble(written.error());
}

}  // namespace backlight
