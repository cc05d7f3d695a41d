// Which images are there already.
#pragma once

#include <string>
#include <vector>

#include "backlight/render/image_header.h"
#include "render_plan.h"
#include "scene_session.h"

namespace backlight {

/// Recognises the files of earlier runs, and of other processes.
class ImageRecogniser {
 public:
  /// The session has compiled its scene. Fails if a file that the scene names cannot be read any more.
  static Result<ImageRecogniser> of(const RenderOptions& options, SceneSession& session);

  /// The identity of an image; empty when its numbers are wrong, which compiling it reports.
  [[nodiscard]] std::string identity(const PlannedImage& image) const;
  /// What its header says of its origin.
  [[nodiscard]] ImageOrigin origin(const PlannedImage& image) const;
  /// Whether its file is there, complete and the same.
  [[nodiscard]] bool is_complete(const PlannedImage& image) const;

 private:
  ImageRecogniser(const RenderOptions& options, const Description& description,
                  std::vector<std::string> digests);

  const RenderOptions* options_;
  const Description* description_;
  std::vector<std::string> digests_;
};

}  // namespace backlight
