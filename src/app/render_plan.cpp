#include "render_plan.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "backlight/base/json_text.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

bool names_a_folder(const fs::path& path) {
  std::error_code error;
  return path.filename().empty() || fs::is_directory(path, error);
}

Result<OutputPattern> output_pattern(const RenderOptions& options) {
  const std::string usual =
      is_standard_input(options.scene.file) ? "stdin.exr" : options.scene.file.stem().string() + ".exr";
  if (!options.output) return OutputPattern::literal(usual);
  const fs::path example = options.output->path(1);
  if (names_a_folder(example)) return options.output->with_file(usual);
  if (example.extension() == ".exr") return *options.output;
  return Failure{"--output: images are written as OpenEXR: '" + example.string() +
                 "' must end in .exr, or in / for a folder" +
                 (example.extension() == ".png" ? " (--png writes a PNG beside the EXR)" : "")};
}

// As a shell would have to read it.
std::string quoted(const std::string& argument) {
  const std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos) return argument;
  std::string text = "'";
  for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

// Options that say which images are made, where they go and how the run is told about: not what is in one.
constexpr std::array flags_of_the_run{"--png",     "--skip-existing", "--no-clobber", "--resume", "--claim",
                                      "--dry-run", "--list-frames",   "-q",           "--quiet",  "-v",
                                      "--verbose"};
constexpr std::array values_of_the_run{"-o",        "--output", "-f",         "--frames",        "--time",
                                       "--crop",    "--stats",  "--progress", "--claim-expires", "-t",
                                       "--threads", "--tone",   "--exposure", "--white"};

template <class Names>
bool is_among(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string> arguments_of_an_image(const std::vector<std::string>& all) {
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string& argument = all[i];
    const bool is_short = argument.size() > 2 && argument[0] == '-' && argument[1] != '-';
    const std::string name = is_short ? argument.substr(0, 2) : argument.substr(0, argument.find('='));
    if (is_among(flags_of_the_run, name)) continue;
    if (!is_among(values_of_the_run, name)) {
      kept.push_back(argument);
    } else if (argument == name) {
      ++i;  // its value
    }
  }
  return kept;
}

}  // namespace

std::string command_for(const RenderOptions& options, const PlannedImage& image,
                        const std::optional<PixelBox>& crop) {
  std::string text = "backlight render";
  for (const std::string& argument : arguments_of_an_image(options.arguments)) text += " " + quoted(argument);
  if (image.request.time) text += " --time " + json_number(*image.request.time);
  if (image.request.frame) text += " -f " + std::to_string(*image.request.frame);
  if (crop) {
    text += " --crop " + std::to_string(crop->x0) + "," + std::to_string(crop->y0) + "," +
            std::to_string(crop->x1) + "," + std::to_string(crop->y1);
  }
  return text + " -o again.exr";
}

PixelBox one_pixel(int x, int y) {
  return {x, y, x + 1, y + 1};
}

Result<std::vector<PlannedImage>> plan_images(const RenderOptions& options,
                                              const std::vector<int>& scene_frames) {
  auto pattern = output_pattern(options);
  if (!pattern.ok()) return pattern.failure();
  std::vector<ImageRequest> requests;
  if (options.time) {
    requests.push_back(options.scene.request);
    requests.back().time = options.time;
  } else {
    for (const int frame : options.frames.value_or(scene_frames)) {
      requests.push_back(options.scene.request);
      requests.back().frame = frame;
    }
  }
  const bool numbered = requests.size() > 1 || (!options.time && scene_frames.size() > 1);
  if (numbered) pattern = pattern.value().numbered();

  std::vector<PlannedImage> images;
  for (const ImageRequest& request : requests) {
    PlannedImage image{request, pattern.value().path(request.frame.value_or(1)), {}};
    if (options.png) image.png = fs::path(image.exr).replace_extension(".png");
    images.push_back(std::move(image));
  }
  return images;
}

}  // namespace backlight
