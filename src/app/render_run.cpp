// Longer than 400 lines: an image's whole way, from the claim to the PNG beside it, in one place.
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
#include "backlight/film/exposure.h"
#include "backlight/render/image_identity.h"
#include "backlight/render/partial_file.h"
#include "backlight/render/wavelength_estimate.h"
#include "display_words.h"
#include "exit_codes.h"
#include "signals.h"

namespace backlight {
namespace {

int threads_for(const RenderOptions& options) {
  return options.threads > 0 ? options.threads : usable_threads();
}

RenderSettings settings_for(const RenderOptions& options, const Scene& scene, const Needs& needs) {
  RenderSettings settings;
  settings.threads = threads_for(options);
  settings.crop = options.crop;
  settings.wavelengths = needs.wavelengths;
  settings.image_number = static_cast<std::int64_t>(std::floor(std::clamp(scene.frame, -1e15, 1e15)));
  return settings;
}

std::filesystem::path claim_path(const PlannedImage& image) {
  return image.exr.string() + ".claim";
}

PixelBox one_pixel(int x, int y) {
  return {x, y, x + 1, y + 1};
}

}  // namespace

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
  std::vector<const PlannedImage*> all;
  for (const PlannedImage& image : images_) all.push_back(&image);
  threads_.emplace(threads_for(options_), pause_requested());
  serve_in_background();  // the storing threads too, which are begun from here
  Outcome outcome = take_all(all);
  if (outcome == Outcome::made || outcome == Outcome::failed) {
    const Outcome others = wait_for_others();
    if (others != Outcome::made) outcome = others;
  }
  deliveries_.wait();
  tell_time();
  if (outcome == Outcome::stopped) return exit_stopped + stop_signal();
  if (outcome == Outcome::file_trouble || deliveries_.has_failed()) return exit_file_trouble;
  return outcome == Outcome::made ? exit_success : exit_frame_failed;
}

// Those that other processes work on go to waiting_. `failed`: not all of the others could be made.
RenderRun::Outcome RenderRun::take_all(const std::vector<const PlannedImage*>& images) {
  bool all_made = true;
  const auto ends_the_run = [&](Outcome outcome) {
    if (outcome == Outcome::failed) all_made = false;
    return outcome == Outcome::stopped || outcome == Outcome::file_trouble;
  };
  for (const PlannedImage* image : images) {
    if (const Outcome outcome = make_room(); ends_the_run(outcome)) return outcome;
    const Outcome outcome = take(*image);
    first_.reset();
    if (outcome == Outcome::claimed_by_another) waiting_.push_back(image);
    if (ends_the_run(outcome)) {
      // What is in hand is nearly done; a file that cannot be written does not undo it.
      const Outcome rest = finish_all();
      return rest == Outcome::stopped ? rest : outcome;
    }
  }
  if (const Outcome outcome = finish_all(); ends_the_run(outcome)) return outcome;
  return all_made ? Outcome::made : Outcome::failed;
}

// Until another image may be begun: one is traced at a time, and the next is ready when its end is near. Of
// images that take no longer than a few time slices of the scheduler there are more, or tracing would wait
// for this thread to get its turn.
RenderRun::Outcome RenderRun::make_room() {
  constexpr double ahead = 0.06;  // seconds
  const auto most = static_cast<std::size_t>(std::clamp(ahead / std::max(last_seconds_, 1e-6), 2.0, 24.0));
  Outcome outcome = Outcome::made;
  while (!in_hand_.empty() && (in_hand_.size() >= most || threads_->first_is_done())) {
    outcome = std::max(outcome, finish_first());
    if (outcome > Outcome::failed) break;
  }
  threads_->wait_for_tail();
  if (stop_requested()) {
    const Outcome rest = finish_all();
    return rest == Outcome::file_trouble ? rest : Outcome::stopped;
  }
  return deliveries_.has_failed() ? Outcome::file_trouble : outcome;
}

// The worst that came of them.
RenderRun::Outcome RenderRun::finish_all() {
  Outcome worst = Outcome::made;
  while (!in_hand_.empty()) worst = std::max(worst, finish_first());
  return worst;
}

RenderRun::Outcome RenderRun::finish_first() {
  const std::shared_ptr<Work> work = in_hand_.front();
  const Outcome outcome = explained(*work->image, work->scene.film, [&] { return finish(work); });
  in_hand_.pop_front();
  if (outcome != Outcome::made) progress_.drop_image();
  if (outcome == Outcome::claimed_by_another) waiting_.push_back(work->image);
  return outcome;
}

// What another process does not finish falls to this one: at the end every image is there, whoever made it.
RenderRun::Outcome RenderRun::wait_for_others() {
  bool all_made = true;
  if (!waiting_.empty() && options_.verbosity != Verbosity::quiet) {
    progress_.say("waiting for " + std::to_string(waiting_.size()) +
                  " images in the hands of other processes");
  }
  while (!waiting_.empty()) {
    const Outcome outcome = take_all(std::exchange(waiting_, {}));
    if (outcome == Outcome::stopped || outcome == Outcome::file_trouble) return outcome;
    if (outcome == Outcome::failed) all_made = false;
    for (int i = 0; i < 10 && !waiting_.empty() && !stop_requested(); ++i)
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
  if (!options_.claim) return begin(image, nullptr);
  auto attempt = Claim::attempt(claim_path(image), options_.claim_expiry);
  if (!attempt.ok()) return trouble(attempt.error());
  std::unique_ptr<Claim> claim = std::move(attempt.value().claim);
  if (!claim) return Outcome::claimed_by_another;
  // It may have been finished by another between the look at it and the claim.
  if (recogniser_.is_complete(image)) return skip(image, "is complete");
  return begin(image, std::move(claim));
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
  const auto png = complete_png(image);
  if (!png.ok()) return trouble(png.error());
  tell_of_png(image, png.value());
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

// What goes wrong with one image is told, and the others are made.
template <class Step>
RenderRun::Outcome RenderRun::explained(const PlannedImage& image, const FilmSettings& film,
                                        const Step& step) {
  std::string what;
  std::optional<PixelBox> crop = options_.crop;
  try {
    return step();
  } catch (const std::bad_alloc&) {
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

RenderRun::Outcome RenderRun::begin(const PlannedImage& image, std::unique_ptr<Claim> claim) {
  std::optional<Scene> scene = std::exchange(first_, std::nullopt);
  if (!scene) scene = session_.compile(image.request);
  if (!scene) return Outcome::failed;
  const auto work = std::make_shared<Work>(image, *std::move(scene));
  work->claim = std::move(claim);
  const Outcome outcome = explained(image, work->scene.film, [&] { return start(*work); });
  if (outcome == Outcome::begun) in_hand_.push_back(work);
  return outcome;
}

RenderRun::Outcome RenderRun::start(Work& work) {
  work.needs = needs_within_tolerance(work.scene);
  work.settings = settings_for(options_, work.scene, work.needs);
  const auto creation_time = source_date_epoch();
  if (!creation_time.ok()) return trouble(creation_time.error());
  work.header = image_header(work.scene, work.settings.wavelengths, recogniser_.origin(*work.image),
                             creation_time.value());
  work.partial = begin_image(work.scene, work.settings);
  if (options_.resume) resume(*work.image, work.partial);
  progress_.begin_image(work.image->exr.string(), tile_count(work.scene, work.settings));
  work.tracing =
      std::make_unique<ImageTracing>(work.scene, work.settings, work.partial, pause_requested(), &progress_);
  threads_->begin(*work.tracing);
  return Outcome::begun;
}

RenderRun::Outcome RenderRun::finish(const std::shared_ptr<Work>& work) {
  while (true) {
    work->statistics.seconds += threads_->finish();
    if (work->partial.is_complete()) {
      // The image itself is at hand; where there is another behind it, the snapshot is of that.
      if (in_hand_.size() == 1) take_snapshot_request();
      break;
    }
    if (take_snapshot_request() && !stop_requested()) snapshot(*work);
    if (stop_requested()) return stop(*work);
    progress_.restart_images();
    threads_->go_on_with(*work->tracing);
  }
  const double seconds = last_seconds_ = work->statistics.seconds;
  work->statistics = work->tracing->statistics();
  work->statistics.seconds = seconds;
  work->tracing.reset();
  if (work->claim != nullptr && !work->claim->is_held()) {
    progress_.say("backlight: warning: " + work->image->exr.string() +
                  ": another process took the claim over, which had expired; it will write the image");
    return Outcome::claimed_by_another;
  }
  return deliver(work);
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

void RenderRun::snapshot(const Work& work) {
  const std::filesystem::path path = partial_path(work.image->exr);
  const auto written = write_partial(path, work.partial, work.header);
  if (!written.ok()) {
    progress_.say("backlight: warning: " + written.error());  // the image itself may yet find its place
  } else if (options_.verbosity != Verbosity::quiet) {
    progress_.say("wrote the snapshot " + path.string());
  }
}

RenderRun::Outcome RenderRun::stop(const Work& work) {
  const bool behind_another = std::exchange(has_stopped_, true);
  if (behind_another && !work.partial.has_any()) return Outcome::stopped;
  const std::filesystem::path path = partial_path(work.image->exr);
  if (const auto written = write_partial(path, work.partial, work.header); !written.ok())
    return trouble(written.error());
  if (options_.verbosity != Verbosity::quiet) {
    progress_.say("stopped; wrote " + path.string() + ", which --resume finishes");
  }
  return Outcome::stopped;
}

RenderRun::Outcome RenderRun::deliver(const std::shared_ptr<Work>& work) {
  const Image& image = work->partial.image;
  const std::size_t bytes = image.channel_count() * image.plane(0).size_bytes();
  deliveries_.add(
      bytes, [this, work] { return store(*work); },
      [this, work](const Result<void>& stored) { return conclude(*work, stored); });
  if (work->image == &images_.back()) deliveries_.wait();  // the end that progress tells is the end
  progress_.end_image();
  return deliveries_.has_failed() ? Outcome::file_trouble : Outcome::made;
}

Result<void> RenderRun::store(Work& work) const {
  const PlannedImage& image = *work.image;
  work.faults = faults_of(work.partial.image);
  std::error_code ignored;
  // The PNG of an earlier image must not stand beside this one, should the process end between the two.
  if (!image.png.empty()) std::filesystem::remove(image.png, ignored);
  const auto written =
      write_exr(image.exr, work.partial.image, work.header, options_.storage, work.settings.threads);
  if (!written.ok()) return written;
  auto png = complete_png(image);
  if (!png.ok()) return png.failure();
  work.png_lines = std::move(png).value();
  return {};
}

Result<void> RenderRun::conclude(Work& work, const Result<void>& stored) {
  work.record =
      statistics_json(work.scene, work.needs, work.settings, work.statistics, work.faults, work.image->exr);
  const Result<void> done = stored.ok() ? statistics_.write(work.record) : stored;
  if (done.ok()) {
    remove_superseded(*work.image);
    tell(work);
  } else {
    trouble(done.error());
  }
  work.claim.reset();
  return done;
}

// The PNG is made from the file, so that it can be made later too, with the same bytes.
Result<std::vector<std::string>> RenderRun::complete_png(const PlannedImage& image) const {
  std::error_code error;
  if (image.png.empty() || std::filesystem::exists(image.png, error)) return std::vector<std::string>{};
  const auto picture = read_exr(image.exr);
  if (!picture.ok()) return picture.failure();
  LuminanceCounts counts;
  if (options_.display.is_automatic()) {
    if (const auto added = counts.add(picture.value().image, 0); !added.ok()) return added.failure();
  }
  const DisplayTransform transform = options_.display.transform(counts);
  const auto displayed = display_image(picture.value().image, transform);
  if (!displayed.ok()) return displayed.failure();
  if (const auto written = write_png(image.png, displayed.value().pixels); !written.ok())
    return written.failure();
  std::vector<std::string> lines;
  if (transform.tone == ToneCurve::none) lines = lines_of(displayed.value().report);
  if (const std::string words = words_of(transform); options_.display.is_automatic() && !words.empty())
    lines.insert(lines.begin(), words);
  return lines;
}

void RenderRun::tell_of_png(const PlannedImage& image, const std::vector<std::string>& lines) {
  if (options_.verbosity == Verbosity::quiet || progress_.style() == ProgressStyle::json) return;
  for (const std::string& line : lines) progress_.say(image.png.string() + ": " + line);
  const bool chosen = !lines.empty() && !options_.display.tone && !std::exchange(has_told_of_film_, true);
  if (!chosen || images_.size() < 2) return;
  progress_.say(
      "  each PNG is shown as suits it alone; for a film, view all of them together, or give --tone, "
      "--exposure and --white");
}

void RenderRun::tell(const Work& work) {
  const PlannedImage& planned = *work.image;
  const RenderStatistics& statistics = work.statistics;
  const ImageFaults& faults = work.faults;
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
  if (faults.saturated > 0) {
    progress_.say("backlight: warning: " + file + ": " + std::to_string(faults.saturated) +
                  " pixels are brighter than a film value can be (3.4e38); their colour is kept, their "
                  "brightness is not\n  a smaller 'exposure' of [film] may show them");
  }
  if (statistics.rays.unresolved > 0) {
    progress_.say("backlight: warning: " + file + ": " + std::to_string(statistics.rays.unresolved) + " of " +
                  std::to_string(statistics.rays.primary) +
                  " camera rays meet a surface where its root is not resolved (the channel 'unresolved' "
                  "shows where)");
  }
  if (options_.verbosity == Verbosity::quiet) return;
  if (progress_.style() == ProgressStyle::json) {
    progress_.say(R"({"event":"image",)" + work.record.substr(1));
    return;
  }
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.2f s", statistics.seconds);
  progress_.say(file + "  " + seconds);
  tell_of_png(planned, work.png_lines);
  if (options_.verbosity == Verbosity::verbose)
    progress_.say(statistics_words(work.scene, work.settings, statistics));
}

// Whether the threads always had something to do.
void RenderRun::tell_time() {
  const TracingTime time = threads_->time();
  if (options_.verbosity == Verbosity::quiet || !(time.seconds > 0.0)) return;
  if (progress_.style() == ProgressStyle::json) {
    progress_.say(time_json(time));
  } else if (options_.verbosity == Verbosity::verbose) {
    progress_.say(time_words(time));
  }
}

}  // namespace backlight
