// Which images a render makes, and where they go.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "backlight/base/result.h"
#include "options.h"

namespace backlight {

struct PlannedImage {
  ImageRequest request;
  std::filesystem::path exr;
  std::filesystem::path png;  ///< empty when none is asked for
};

/// The command that makes a crop of one image again, as it would be typed: the options of this run that say
/// what is rendered, and a file of its own to write to.
std::string command_for(const RenderOptions& options, const PlannedImage& image,
                        const std::optional<PixelBox>& crop);

/// As a crop.
PixelBox one_pixel(int x, int y);

/// The images, in the order of rendering; `scene_frames` are those of the scene's [animation]. Their names
/// get a number when there are several, and when they are some frames of an animation: jobs that render one
/// frame each then write different files. Fails if the output is not named like an EXR file.
Result<std::vector<PlannedImage>> plan_images(const RenderOptions& options,
                                              const std::vector<int>& scene_frames);

}  // namespace backlight
