#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <utility>

#include "backlight/base/files.h"
#include "backlight/base/json_text.h"
#include "backlight/base/thread_pool.h"
#include "backlight/film/display.h"
#include "backlight/render/image_header.h"
#include "backlight/render/progress.h"
#include "backlight/render/render.h"
#include "backlight/scene/needs.h"
#include "commands.h"
#include "exit_codes.h"
#include "messages.h"
#include "render_plan.h"
#include "scene_session.h"
#include "signals.h"
#include "statistics.h"

namespace backlight {
namespace {

// All the images of a run, one after the other.
class RenderRun {
 public:
  RenderRun(const RenderOptions& options, SceneSession& session, const std::vector<PlannedImage>& images,
            StatisticsFile statistics)
      : options_(options),
        session_(session),
        images_(images),
        statistics_(std::move(statistics)),
        progress_(std::cerr, {options.verbosity == Verbosity::quiet ? ProgressStyle::none : options.progress,
                              static_cast<int>(images.size())}) {}

  /// Returns the exit code. `first` is the scene of the first image.
  int run(Scene first) {
    std::optional<Scene> scene = std::move(first);
    bool all_made = true;
    for (const PlannedImage& image : images_) {
      if (!scene) scene = session_.compile(image.request);
      const int code = scene ? make_or_explain(*scene, image) : static_cast<int>(exit_frame_failed);
      scene.reset();
      if (stop_requested()) return exit_stopped + stop_signal();
      if (code == exit_file_trouble) return code;
      if (code != exit_success) all_made = false;
    }
    return all_made ? exit_success : exit_frame_failed;
  }

 private:
  int make_or_explain(const Scene& scene, const PlannedImage& image) {
    try {
      return make(scene, image);
    } catch (const std::bad_alloc&) {
      const FilmSettings& film = scene.film;
      progress_.say("backlight: error: " + image.exr.string() + ": not enough memory for an image of " +
                    std::to_string(film.width) + "x" + std::to_string(film.height) +
                    " pixels; render it in parts with --crop");
      return exit_frame_failed;
    } catch (const std::exception& error) {
      progress_.say("backlight: error: " + image.exr.string() + ": " + error.what() +
                    "\n  again: backlight render " + options_.scene.file.string() + image.arguments());
      return exit_frame_failed;
    }
  }

  int make(const Scene& scene, const PlannedImage& planned) {
    RenderSettings settings;
    settings.threads = options_.threads > 0 ? options_.threads : usable_threads();
    settings.crop = options_.crop;
    settings.wavelengths = needs_of(scene).wavelengths;
    settings.image_number = static_cast<std::int64_t>(std::floor(std::clamp(scene.frame, -1e15, 1e15)));
    progress_.begin_image(planned.exr.string(), tile_count(scene, settings));
    const auto rendered = render_image(scene, settings, stop_requested(), &progress_);
    if (!rendered) return exit_stopped;
    Result<void> written = write(scene, planned, rendered->image);
    if (written.ok()) {
      written = statistics_.write(statistics_json(scene, settings, rendered->statistics, planned.exr));
    }
    if (!written.ok()) {
      progress_.say("backlight: error: " + written.error());
      return exit_file_trouble;
    }
    progress_.end_image();
    tell(scene, settings, planned, rendered->statistics);
    return exit_success;
  }

  Result<void> write(const Scene& scene, const PlannedImage& planned, const Image& image) const {
    const auto creation_time = source_date_epoch();
    if (!creation_time.ok()) return creation_time.failure();
    const Description& description = session_.description();
    const ImageOrigin origin{"Backlight " BACKLIGHT_VERSION, options_.scene.file.filename().string(),
                             description.sha256, description.overrides};
    const ExrHeader header = image_header(scene, origin, creation_time.value());
    if (auto written = write_exr(planned.exr, image, header, options_.storage); !written.ok()) return written;
    if (planned.png.empty()) return {};
    const auto displayed = display_image(image, DisplayTransform{});
    if (!displayed.ok()) return displayed.failure();
    return write_png(planned.png, displayed.value().pixels);
  }

  void tell(const Scene& scene, const RenderSettings& settings, const PlannedImage& planned,
            const RenderStatistics& statistics) {
    const std::string file = planned.exr.string();
    if (statistics.rays.non_finite > 0) {
      progress_.say("backlight: warning: " + file + ": " + std::to_string(statistics.rays.non_finite) +
                    " pixels are not finite");
    }
    if (options_.verbosity == Verbosity::quiet) return;
    if (progress_.style() == ProgressStyle::json) {
      progress_.say(R"({"event":"image",)" +
                    statistics_json(scene, settings, statistics, planned.exr).substr(1));
      return;
    }
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.2f s", statistics.seconds);
    progress_.say(file + "  " + seconds);
    if (options_.verbosity == Verbosity::verbose) progress_.say(details(scene, settings, statistics));
  }

  static std::string details(const Scene& scene, const RenderSettings& settings,
                             const RenderStatistics& statistics) {
    const std::string colour = settings.wavelengths > 0
                                   ? std::to_string(settings.wavelengths) + " wavelengths"
                                   : "red, green and blue";
    return "  t = " + json_number(scene.time) + " s, " + std::to_string(scene.film.samples) +
           " samples a pixel, " + colour + ", " + std::to_string(statistics.rays.primary) + " camera rays, " +
           std::to_string(statistics.rays.shadow) + " shadow rays, " + std::to_string(statistics.threads) +
           " threads";
  }

  const RenderOptions& options_;
  SceneSession& session_;
  const std::vector<PlannedImage>& images_;
  StatisticsFile statistics_;
  ProgressReporter progress_;
};

// Better now than after an hour of rendering.
Result<void> try_output(const std::filesystem::path& path) {
  auto file = AtomicFile::create(path);
  if (!file.ok()) return file.failure();
  file.value().abandon();
  return {};
}

void print_files(const std::vector<PlannedImage>& images, const Scene& first, bool numbers) {
  for (const PlannedImage& image : images) {
    const std::string number = numbers ? json_number(image.request.frame.value_or(first.frame)) + "\t" : "";
    std::cout << number << image.exr.string() << '\n';
    if (!image.png.empty()) std::cout << number << image.png.string() << '\n';
  }
}

int usage_trouble(const std::string& message) {
  print_error(message);
  return exit_usage;
}

int file_trouble(const std::string& message) {
  print_error(message);
  return exit_file_trouble;
}

}  // namespace

int run(const RenderOptions& options) {
  catch_stop_signals();
  SceneSession session(options.scene);
  if (session.exit_code() != exit_success) return session.exit_code();
  const auto images = plan_images(options, session.frames());
  if (!images.ok()) return usage_trouble(images.error());
  const bool nothing_planned = images.value().empty();  // [animation] is wrong: compile() says how
  auto first = session.compile(nothing_planned ? options.scene.request : images.value().front().request);
  if (!first || nothing_planned) return exit_scene_wrong;

  const FilmSettings& film = first->film;
  if (options.crop && (options.crop->x1 > film.width || options.crop->y1 > film.height)) {
    return usage_trouble("--crop: reaches beyond the image, which is " + std::to_string(film.width) + "x" +
                         std::to_string(film.height));
  }
  if (options.dry_run || options.list_frames) {
    print_files(images.value(), *first, options.list_frames);
    return exit_success;
  }
  if (const auto tried = try_output(images.value().front().exr); !tried.ok())
    return file_trouble(tried.error());
  auto statistics = StatisticsFile::open(options.statistics);
  if (!statistics.ok()) return file_trouble(statistics.error());
  return RenderRun(options, session, images.value(), std::move(statistics).value()).run(std::move(*first));
}

}  // namespace backlight
