// The images of one run of `backlight render`, one after the other.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "backlight/base/claim.h"
#include "backlight/base/helper_thread.h"
#include "backlight/render/image_file.h"
#include "backlight/render/image_header.h"
#include "backlight/render/progress.h"
#include "backlight/render/render.h"
#include "backlight/render/tracing_threads.h"
#include "delivery_queue.h"
#include "image_recogniser.h"
#include "render_plan.h"
#include "scene_session.h"
#include "statistics.h"

namespace backlight {

class RenderRun {
 public:
  RenderRun(const RenderOptions& options, SceneSession& session, const ImageRecogniser& recogniser,
            const std::vector<PlannedImage>& images, StatisticsFile statistics);

  /// Returns the exit code. `first` is the scene of the first image.
  int run(Scene first);

 private:
  // In the order of what the run comes to.
  enum class Outcome { begun, made, skipped, claimed_by_another, failed, file_trouble, stopped };

  /// An image from its compiled scene to its file.
  struct Work {
    Work(const PlannedImage& the_image, Scene the_scene) : image(&the_image), scene(std::move(the_scene)) {}

    const PlannedImage* image;
    Scene scene;
    Needs needs;
    RenderSettings settings;
    std::unique_ptr<PartialImage> partial;  ///< until all of it is in the file
    std::unique_ptr<ImageFile> file;
    std::unique_ptr<ImageTracing> tracing;  ///< while it is in the hands of the threads
    ExrHeader header;
    std::unique_ptr<Claim> claim;  ///< null: without
    RenderStatistics statistics;
    bool lacks_memory = false;           ///< to be stored
    std::vector<std::string> png_lines;  ///< to be said of the PNG
    std::string record;                  ///< the object of --stats
  };

  bool begin_threads();
  Outcome take_all(const std::vector<const PlannedImage*>& images);
  Outcome make_room();
  Outcome finish_first();
  Outcome finish_all();
  Outcome take(const PlannedImage& image);
  Outcome wait_for_others();
  template <class Step>
  Outcome explained(const PlannedImage& image, const FilmSettings& film, const Step& step);
  Outcome begin(const PlannedImage& image, std::unique_ptr<Claim> claim);
  Outcome scene_is_wrong(const PlannedImage& image);
  Outcome start(Work& work);
  void begin_pixels(Work& work);
  void begin_tracing(Work& work);
  /// Throws what to do instead where the image's pixels do not fit into memory.
  Outcome find_memory(const Work& work);
  Outcome finish(const std::shared_ptr<Work>& work);
  static bool has_lost_claim(const Work& work);
  Outcome stop(const Work& work);
  /// Sends the image on its way; store() and conclude() follow on a thread of their own.
  Outcome deliver(const std::shared_ptr<Work>& work);
  [[nodiscard]] Result<void> store(Work& work) const;
  Result<void> conclude(Work& work, const Result<void>& stored);
  void tell_of_lack(Work& work);
  void record(Work& work);
  Outcome skip(const PlannedImage& image, const std::string& why);
  Outcome trouble(const std::string& what);

  /// Makes the PNG unless it is there; returns what is to be said of how.
  [[nodiscard]] Result<std::vector<std::string>> complete_png(const PlannedImage& image) const;
  void tell_of_png(const PlannedImage& image, const std::vector<std::string>& lines);
  void remove_superseded(const PlannedImage& image) const;
  void resume(Work& work);
  void snapshot(const Work& work);
  static std::string lack_of_memory(const FilmSettings& film);
  void tell(const Work& work);
  void tell_time();

  const RenderOptions& options_;
  SceneSession& session_;
  const ImageRecogniser& recogniser_;
  const std::vector<PlannedImage>& images_;
  StatisticsFile statistics_;
  ProgressReporter progress_;
  bool lost_statistics_ = false;
  bool lacked_memory_ = false;  // for an image that was traced
  std::optional<Scene> first_;
  bool has_stopped_ = false;
  bool some_failed_ = false;  // of those that were finished to make room for another
  bool has_told_of_film_ = false;
  double last_seconds_ = 1.0;                  // that the image before took
  std::optional<Claimant> claimant_;           // behind those who have claims
  std::vector<const PlannedImage*> waiting_;   // in the hands of other processes
  std::vector<std::filesystem::path> left_;    // claims beside complete images
  std::deque<std::shared_ptr<Work>> in_hand_;  // being traced, or begun behind those
  std::optional<HelperThread> helper_;         // where a CPU is left for one
  std::optional<TracingThreads> threads_;      // behind what they trace
  DeliveryQueue deliveries_;                   // last: what is on its way uses the others
};

}  // namespace backlight
