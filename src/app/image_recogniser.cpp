#include "image_recogniser.h"

#include <utility>

#include "backlight/render/image_identity.h"

namespace backlight {

ImageRecogniser::ImageRecogniser(const RenderOptions& options, const Description& description,
                                 std::vector<std::string> digests)
    : options_(&options), description_(&description), digests_(std::move(digests)) {}

Result<ImageRecogniser> ImageRecogniser::of(const RenderOptions& options, SceneSession& session) {
  auto digests = session.resource_digests();
  if (!digests.ok()) return digests.failure();
  return ImageRecogniser(options, session.description(), std::move(digests).value());
}

ImageOrigin ImageRecogniser::origin(const PlannedImage& image) const {
  ImageOrigin origin{"Backlight " BACKLIGHT_VERSION,
                     options_->scene.file.filename().string(),
                     description_->sha256,
                     description_->overrides,
                     {}};
  if (const auto facts = image_facts(*description_, image.request)) {
    origin.identity = image_identity(origin, digests_, *facts);
  }
  return origin;
}

std::string ImageRecogniser::identity(const PlannedImage& image) const {
  return origin(image).identity;
}

bool ImageRecogniser::is_complete(const PlannedImage& image) const {
  return is_complete_image(image.exr, identity(image), options_->crop, options_->storage);
}

}  // namespace backlight
