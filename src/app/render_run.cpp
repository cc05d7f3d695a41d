#include "render_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <thread>
#include <utility>

#include "backlight/base/json_text.h"
#include "backlight/base/thread_pool.h"
#include "backlight/film/display.h"
#include "backlight/render/image_identity.h"
#include "backlight/render/partial_file.h"
#include "backlight/render/wavelength_estimate.h"
#include "exit_codes.h"
#include "signals.h"

namespace backlight {
namespace {

std::string details(const Scene& scene, const RenderSettings& settings, const RenderStatistics& statistics) {
  const std::string colour = settings.wavelengths > 0 ? std::to_string(settings.wavelengths) + " wavelengths"
                                                      : "red, green and blue";
  return "  t = " + json_number(scene.time) + " s, " + json_number(statistics.samples.mean()) +
         " samples a pixel, " + colour + ", " + std::to_string(statistics.rays.primary) + " camera rays, " +
         std::to_string(statistics.rays.shadow) + " shadow rays, " + std::to_string(statistics.threads) +
         " threads";
}

RenderSettings settings_for(const RenderOptions& options, const Scene& scene, const Needs& needs) {
  RenderSettings settings;
  settings.threads = options.threads > 0 ? options.threads : usable_threads();
  settings.crop = options.crop;
  settings.wavelengths = needs.wavelengths;
  settings.image_number = static_cast<std::int64_t>(std::floor(std::clamp(scene.frame, -1e15, 1e15)));
  return settings;
}

void add(RenderStatistics& sum, const RenderStatistics& more) {
  sum.rays += more.rays;
  sum.samples += more.samples;
  sum.strategy = more.strategy;
  sum.seconds += more.seconds;
  sum.threads = more.threads;
}

std::filesystem::path claim_path(const PlannedImage& image) {
  return image.exr.string() + ".claim";
}

PixelBox one_pixel(int x, int y) {
  return {x, y, x + 1, y + 1};
}

}  // namespace

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

RenderRun::RenderRun(const RenderOptions& options, SceneSession& session, const ImageRecogniser& recogniser,
                     const std::vector<PlannedImage>& images, StatisticsFile statistics)
    : options_(options),
      session_(session),
      recogniser_(recogniser),
      images_(images),
      statistics_(std::move(statistics)),
      progress_(std::cerr, {options.verbosity == Verbosity::quiet ? ProgressStyle::none : options.progress,
                            static_cast<int>(images.size())}) {}

int RenderRun::run(Scene first) {
  first_ = std::move(first);
  std::vector<const PlannedImage*> waiting;
  Outcome outcome = take_all(waiting);
  if (outcome == Outcome::made || outcome == Outcome::failed) {
    const Outcome others = wait_for_others(std::move(waiting));
    if (others != Outcome::made) outcome = others;
  }
  deliveries_.wait();
  if (outcome == Outcome::stopped) return exit_stopped + stop_signal();
  if (outcome == Outcome::file_trouble || deliveries_.has_failed()) return exit_file_trouble;
  return outcome == Outcome::made ? exit_success : exit_frame_failed;
}

// `waiting` are those that other processes work on. `failed`: not all of the others could be made.
RenderRun::Outcome RenderRun::take_all(std::vector<const PlannedImage*>& waiting) {
  bool all_made = true;
  for (const PlannedImage& image : images_) {
    if (deliveries_.has_failed()) return Outcome::file_trouble;
    const bool stopped_before = stop_requested();
    const Outcome outcome = stopped_before ? Outcome::stopped : take(image);
    first_.reset();
    if (outcome == Outcome::stopped || outcome == Outcome::file_trouble) return outcome;
    if (outcome == Outcome::claimed_by_another) waiting.push_back(&image);
    if (outcome == Outcome::failed) all_made = false;
  }
  return all_made ? Outcome::made : Outcome::failed;
}

// What another process does not finish falls to this one: at the end every image is there, whoever made it.
RenderRun::Outcome RenderRun::wait_for_others(std::vector<const PlannedImage*> waiting) {
  bool all_made = true;
  if (!waiting.empty() && options_.verbosity != Verbosity::quiet) {
    progress_.say("waiting for " + std::to_string(waiting.size()) +
                  " images in the hands of other processes");
  }
  while (!waiting.empty()) {
    std::vector<const PlannedImage*> still;
    for (const PlannedImage* image : waiting) {
      const Outcome outcome = stop_requested() ? Outcome::stopped : take(*image);
      if (outcome == Outcome::stopped || outcome == Outcome::file_trouble) return outcome;
      if (outcome == Outcome::claimed_by_another) still.push_back(image);
      if (outcome == Outcome::failed) all_made = false;
    }
    waiting = std::move(still);
    for (int i = 0; i < 10 && !waiting.empty() && !stop_requested(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return all_made ? Outcome::made : Outcome::failed;
}

RenderRun::Outcome RenderRun::take(const PlannedImage& image) {
  if (options_.skip_existing && recogniser_.is_complete(image)) {
    std::error_code ignored;
    // A process that was killed at the very end leaves a claim; to take it is to remove it.
    if (options_.claim && std::filesystem::exists(claim_path(image), ignored)) {
      if (const auto left = Claim::attempt(claim_path(image), options_.claim_expiry); !left.ok())
        return trouble(left.error());
    }
    return skip(image, "is complete");
  }
  if (!options_.claim) return make_or_explain(image, nullptr);
  auto attempt = Claim::attempt(claim_path(image), options_.claim_expiry);
  if (!attempt.ok()) return trouble(attempt.error());
  std::unique_ptr<Claim> claim = std::move(attempt.value().claim);
  if (!claim) return Outcome::claimed_by_another;
  // It may have been finished by another between the look at it and the claim.
  if (recogniser_.is_complete(image)) return skip(image, "is complete");
  return make_or_explain(image, std::move(claim));
}

// The partial image of a finished one, but not of another that has the same name.
void RenderRun::remove_superseded(const PlannedImage& image) const {
  std::error_code ignored;
  const std::filesystem::path partial = partial_path(image.exr);
  if (!std::filesystem::exists(partial, ignored)) return;
  const auto old = read_exr_info(partial);
  if (!old.ok()) return;
  const ImageLayout& layout = old.value().layout;
  const auto* identity = old.value().header.find<std::string>(identity_attribute);
  const bool same_pixels = layout.data == options_.crop.value_or(layout.display);
  if (same_pixels && identity != nullptr && *identity == recogniser_.identity(image)) {
    std::filesystem::remove(partial, ignored);
  }
}

RenderRun::Outcome RenderRun::skip(const PlannedImage& image, const std::string& why) {
  if (const auto written = complete_png(image); !written.ok()) return trouble(written.error());
  remove_superseded(image);
  progress_.skip_image();
  if (options_.verbosity != Verbosity::quiet && progress_.style() != ProgressStyle::json) {
    progress_.say(image.exr.string() + "  " + why + ": skipped");
  }
  return Outcome::skipped;
}

RenderRun::Outcome RenderRun::trouble(const std::string& what) {
  progress_.say("backlight: error: " + what);
  return Outcome::file_trouble;
}

RenderRun::Outcome RenderRun::make_or_explain(const PlannedImage& image, std::unique_ptr<Claim> claim) {
  std::optional<Scene> scene = std::exchange(first_, std::nullopt);
  if (!scene) scene = session_.compile(image.request);
  if (!scene) return Outcome::failed;
  std::string what;
  std::optional<PixelBox> crop = options_.crop;
  try {
    return make(*scene, image, std::move(claim));
  } catch (const std::bad_alloc&) {
    const FilmSettings& film = scene->film;
    what = "not enough memory for an image of " + std::to_string(film.width) + "x" +
           std::to_string(film.height) + " pixels; render it in parts with --crop";
  } catch (const PixelFailure& failure) {
    what = failure.what();
    crop = one_pixel(failure.x, failure.y);
  } catch (const std::exception& error) {
    what = error.what();
  }
  progress_.say("backlight: error: " + image.exr.string() + ": " + what +
                "\n  again: " + command_for(options_, image, crop));
  return Outcome::failed;
}

RenderRun::Outcome RenderRun::make(const Scene& scene, const PlannedImage& image,
                                   std::unique_ptr<Claim> claim) {
  Needs needs = needs_within_tolerance(scene);
  const RenderSettings settings = settings_for(options_, scene, needs);
  const auto creation_time = source_date_epoch();
  if (!creation_time.ok()) return trouble(creation_time.error());
  const ExrHeader header =
      image_header(scene, settings.wavelengths, recogniser_.origin(image), creation_time.value());
  PartialImage partial = begin_image(scene, settings);
  if (options_.resume) resume(image, partial);
  RenderStatistics statistics;
  while (true) {
    progress_.begin_image(image.exr.string(), tile_count(scene, settings));
    add(statistics, render_missing(scene, settings, partial, pause_requested(), &progress_));
    if (partial.is_complete()) {
      take_snapshot_request();  // the image itself is at hand
      break;
    }
    if (take_snapshot_request() && !stop_requested()) snapshot(image, partial, header);
    if (stop_requested()) return stop(image, partial, header);
  }
  if (claim != nullptr && !claim->is_held()) {
    progress_.say("backlight: warning: " + image.exr.string() +
                  ": another process took the claim over, which had expired; it will write the image");
    return Outcome::claimed_by_another;
  }
  return deliver(
      scene, settings,
      {&image, std::move(partial), header, std::move(claim), std::move(needs), statistics, {}, {}, {}});
}

void RenderRun::resume(const PlannedImage& image, PartialImage& partial) {
  const std::filesystem::path path = partial_path(image.exr);
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return;
  const auto read = read_partial(path, recogniser_.identity(image), partial);
  if (!read.ok()) {
    progress_.say("backlight: warning: " + read.error() + "; beginning anew");
  } else if (options_.verbosity != Verbosity::quiet) {
    progress_.say("going on with " + path.string());
  }
}

void RenderRun::snapshot(const PlannedImage& image, const PartialImage& partial, const ExrHeader& header) {
  const std::filesystem::path path = partial_path(image.exr);
  const auto written = write_partial(path, partial, header);
  if (!written.ok()) {
    progress_.say("backlight: warning: " + written.error());  // the image itself may yet find its place
  } else if (options_.verbosity != Verbosity::quiet) {
    progress_.say("wrote the snapshot " + path.string());
  }
}

RenderRun::Outcome RenderRun::stop(const PlannedImage& image, const PartialImage& partial,
                                   const ExrHeader& header) {
  const std::filesystem::path path = partial_path(image.exr);
  if (const auto written = write_partial(path, partial, header); !written.ok())
    return trouble(written.error());
  if (options_.verbosity != Verbosity::quiet) {
    progress_.say("stopped; wrote " + path.string() + ", which --resume finishes");
  }
  return Outcome::stopped;
}

RenderRun::Outcome RenderRun::deliver(const Scene& scene, const RenderSettings& settings, Delivery traced) {
  const auto delivery = std::make_shared<Delivery>(std::move(traced));
  const Image& image = delivery->partial.image;
  const std::filesystem::path& file = delivery->image->exr;
  delivery->faults = faults_of(image);
  delivery->record =
      statistics_json(scene, delivery->needs, settings, delivery->statistics, delivery->faults, file);
  delivery->details = details(scene, settings, delivery->statistics);
  const std::size_t bytes = image.channel_count() * image.plane(0).size_bytes();
  deliveries_.add(
      bytes, [this, delivery] { return store(*delivery); },
      [this, delivery](const Result<void>& stored) { return conclude(*delivery, stored); });
  if (delivery->image == &images_.back()) deliveries_.wait();  // the end that progress tells is the end
  progress_.end_image();
  return deliveries_.has_failed() ? Outcome::file_trouble : Outcome::made;
}

Result<void> RenderRun::store(const Delivery& delivery) const {
  const PlannedImage& image = *delivery.image;
  std::error_code ignored;
  // The PNG of an earlier image must not stand beside this one, should the process end between the two.
  if (!image.png.empty()) std::filesystem::remove(image.png, ignored);
  const auto written = write_exr(image.exr, delivery.partial.image, delivery.header, options_.storage);
  return written.ok() ? complete_png(image) : written;
}

Result<void> RenderRun::conclude(Delivery& delivery, const Result<void>& stored) {
  const Result<void> done = stored.ok() ? statistics_.write(delivery.record) : stored;
  if (done.ok()) {
    remove_superseded(*delivery.image);
    tell(delivery);
  } else {
    trouble(done.error());
  }
  delivery.claim.reset();
  return done;
}

// The PNG is made from the file, so that it can be made later too, with the same bytes.
Result<void> RenderRun::complete_png(const PlannedImage& image) const {
  std::error_code error;
  if (image.png.empty() || std::filesystem::exists(image.png, error)) return {};
  const auto picture = read_exr(image.exr);
  if (!picture.ok()) return picture.failure();
  const auto displayed = display_image(picture.value().image, DisplayTransform{});
  if (!displayed.ok()) return displayed.failure();
  return write_png(image.png, displayed.value().pixels);
}

void RenderRun::tell(const Delivery& delivery) {
  const PlannedImage& planned = *delivery.image;
  const RenderStatistics& statistics = delivery.statistics;
  const ImageFaults& faults = delivery.faults;
  const std::string file = planned.exr.string();
  if (statistics.samples.at_limit > 0) {
    progress_.say("backlight: warning: " + file + ": " + std::to_string(statistics.samples.at_limit) +
                  " pixels got the most samples there are, and may be further off than the tolerance");
  }
  if (faults.first_non_finite) {
    const auto [x, y] = *faults.first_non_finite;
    progress_.say("backlight: warning: " + file + ": " + std::to_string(faults.non_finite) +
                  " pixels are not finite, the first of them " + std::to_string(x) + "," + std::to_string(y) +
                  "\n  again: " + command_for(options_, planned, one_pixel(x, y)));
  }
  if (statistics.rays.unresolved > 0) {
    progress_.say("backlight: warning: " + file + ": " + std::to_string(statistics.rays.unresolved) + " of " +
                  std::to_string(statistics.rays.primary) +
                  " camera rays meet a surface where its root is not resolved (the channel 'unresolved' "
                  "shows where)");
  }
  if (options_.verbosity == Verbosity::quiet) return;
  if (progress_.style() == ProgressStyle::json) {
    progress_.say(R"({"event":"image",)" + delivery.record.substr(1));
    return;
  }
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.2f s", statistics.seconds);
  progress_.say(file + "  " + seconds);
  if (options_.verbosity == Verbosity::verbose) progress_.say(delivery.details);
}

}  // namespace backlight
