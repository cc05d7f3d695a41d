// The images of one run of `backlight render`, one after the other.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "backlight/base/claim.h"
#include "backlight/render/image_faults.h"
#include "backlight/render/image_header.h"
#include "backlight/render/progress.h"
#include "backlight/render/render.h"
#include "delivery_queue.h"
#include "render_plan.h"
#include "scene_session.h"
#include "statistics.h"

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

class RenderRun {
 public:
  RenderRun(const RenderOptions& options, SceneSession& session, const ImageRecogniser& recogniser,
            const std::vector<PlannedImage>& images, StatisticsFile statistics);

  /// Returns the exit code. `first` is the scene of the first image.
  int run(Scene first);

 private:
  enum class Outcome { made, skipped, claimed_by_another, failed, file_trouble, stopped };

  /// A traced image, with what there is to say of it.
  struct Delivery {
    const PlannedImage* image = nullptr;
    PartialImage partial;
    ExrHeader header;
    std::unique_ptr<Claim> claim;  ///< null: without
    Needs needs;
    RenderStatistics statistics;
    ImageFaults faults;
    std::string record;   ///< the object of --stats
    std::string details;  ///< for --verbose
  };

  Outcome take_all(std::vector<const PlannedImage*>& waiting);
  Outcome take(const PlannedImage& image);
  Outcome wait_for_others(std::vector<const PlannedImage*> waiting);
  Outcome make_or_explain(const PlannedImage& image, std::unique_ptr<Claim> claim);
  Outcome make(const Scene& scene, const PlannedImage& image, std::unique_ptr<Claim> claim);
  Outcome stop(const PlannedImage& image, const PartialImage& partial, const ExrHeader& header);
  /// Sends the image on its way; store() and conclude() follow on a thread of their own.
  Outcome deliver(const Scene& scene, const RenderSettings& settings, Delivery traced);
  [[nodiscard]] Result<void> store(const Delivery& delivery) const;
  Result<void> conclude(Delivery& delivery, const Result<void>& stored);
  Outcome skip(const PlannedImage& image, const std::string& why);
  Outcome trouble(const std::string& what);

  Result<void> complete_png(const PlannedImage& image) const;
  void remove_superseded(const PlannedImage& image) const;
  void resume(const PlannedImage& image, PartialImage& partial);
  void snapshot(const PlannedImage& image, const PartialImage& partial, const ExrHeader& header);
  void tell(const Delivery& delivery);

  const RenderOptions& options_;
  SceneSession& session_;
  const ImageRecogniser& recogniser_;
  const std::vector<PlannedImage>& images_;
  StatisticsFile statistics_;
  ProgressReporter progress_;
  std::optional<Scene> first_;
  DeliveryQueue deliveries_;  // last: what is on its way uses the others
};

}  // namespace backlight
