// Which images a render makes, and where they go.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "backlight/base/result.h"
#include "options.h"

namespace backlight {

struct PlannedImage {
  ImageRequest request;
  std::filesystem::path exr;
  std::filesystem::path png;  ///< empty when none is asked for

  /// What to write after "backlight render SCENE" to get this image alone.
  [[nodiscard]] std::string arguments() const;
};

/// The images, in the order of rendering; `scene_frames` are those of the scene's [animation]. Their names
/// get a number when there are several, and when they are some frames of an animation: jobs that render one
/// frame each then write different files. Fails if the output is not named like an EXR file.
Result<std::vector<PlannedImage>> plan_images(const RenderOptions& options,
                                              const std::vector<int>& scene_frames);

}  // namespace backlight
