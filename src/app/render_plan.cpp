#include "render_plan.h"

#include <string>

#include "backlight/base/json_text.h"

namespace backlight {
namespace {

namespace fs = std::filesystem;

bool names_a_folder(const fs::path& path) {
  std::error_code error;
  return path.filename().empty() || fs::is_directory(path, error);
}

Result<OutputPattern> output_pattern(const RenderOptions& options) {
  const std::string usual = options.scene.file.stem().string() + ".exr";
  if (!options.output) return OutputPattern::literal(usual);
  const fs::path example = options.output->path(1);
  if (names_a_folder(example)) return options.output->with_file(usual);
  if (example.extension() == ".exr") return *options.output;
  return Failure{"--output: images are written as OpenEXR: '" + example.string() +
                 "' must end in .exr, or in / for a folder" +
                 (example.extension() == ".png" ? " (--png writes a PNG beside the EXR)" : "")};
}

}  // namespace

std::string PlannedImage::arguments() const {
  std::string text;
  if (request.time) text += " --time " + json_number(*request.time);
  if (request.frame) text += " -f " + std::to_string(*request.frame);
  return text;
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
