// Longer than 400 lines: an image's whole way, from the claim to the PNG beside it, in one place.
#include "render_run.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>
#include <thread>
#include <utility>

#include "backlight/base/thread_pool.h"
#include "backlight/render/partial_file.h"
#include "backlight/render/wavelength_estimate.h"
#include "exit_codes.h"
#include "signals.h"

namespace backlight {
namespace {

int threads_for(const RenderOptions& options) {
  return options.threads > 0 ? options.threads : usable_threads();
}

RenderSettings settings_for(const RenderOptions& options, int threads, const Scene& scene,
                            const Needs& needs) {
  RenderSettings settings;
  settings.threads = threads;
  settings.crop = options.crop;
  settings.wavelengths = needs.wavelengths;
  settings.image_number = static_cast<std::int64_t>(std::floor(std::clamp(scene.frame, -1e15, 1e15)));
  return settings;
}

std::filesystem::path claim_path(const PlannedImage& image) {
  return image.exr.string() + ".claim";
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
  if (!begin_threads()) return exit_frame_failed;
  Outcome outcome = take_all(all);
  if (outcome == Outcome::made || outcome == Outcome::failed) {
    const Outcome others = wait_for_others();
    if (others != Outcome::made) outcome = others;
  }
  deliveries_.wait();
  for (const std::filesystem::path& claim : left_) claimant_->clear(claim);
  tell_time();
  if (outcome == Outcome::stopped) return exit_stopped + stop_signal();
  if (outcome == Outcome::file_trouble || deliveries_.has_failed() || lost_statistics_)
    return exit_file_trouble;
  return outcome == Outcome::made && !lacked_memory_ && !some_failed_ ? exit_success : exit_frame_failed;
}

// Images can be traced with fewer threads than were asked for, and with none but this one.
bool RenderRun::begin_threads() {
  const auto reason = [] { return std::generic_category().message(EAGAIN); };
  try {
    if (options_.claim) claimant_.emplace(options_.claim_expiry);
  } catch (const std::system_error&) {
    progress_.say("backlight: error: cannot begin the thread that renews claims: " + reason() +
                  "; without --claim none is needed");
    return false;
  }
  const int wanted = threads_for(options_);
  threads_.emplace(wanted, pause_requested());
  if (threads_->count() < wanted) {
    progress_.say("backlight: warning: " + std::to_string(threads_->count()) + " of " +
                  std::to_string(wanted) + " threads could be begun: " + reason());
  }
  serve_in_background();  // the storing threads and the helper too, which are begun from here
  if (wanted < usable_threads()) helper_.emplace();
  return true;
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
    if (waiting_.empty()) break;
    const auto end = std::chrono::steady_clock::now() + claimant_->pause();
    while (std::chrono::steady_clock::now() < end && !stop_requested())
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return all_made ? Outcome::made : Outcome::failed;
}

RenderRun::Outcome RenderRun::take(const PlannedImage& image) {
  if (options_.skip_existing && recogniser_.is_complete(image)) {
    std::error_code ignored;
    // A process that was killed at the very end leaves a claim.
    if (options_.claim && std::filesystem::exists(claim_path(image), ignored)) {
      claimant_->clear(claim_path(image));
      left_.push_back(claim_path(image));
    }
    return skip(image, "is complete");
  }
  if (!options_.claim) return begin(image, nullptr);
  auto attempt = claimant_->attempt(claim_path(image));
  if (!attempt.ok()) return trouble(attempt.error());
  std::unique_ptr<Claim> claim = std::move(attempt.value().claim);
  if (!claim) return Outcome::claimed_by_another;
  if (const std::string& from = attempt.value().taken_from;
      !from.empty() && options_.verbosity != Verbosity::quiet)
    progress_.say(image.exr.string() + "  taken over from " + from);
  // It may have been finished by another between the look at it and the claim.
  if (recogniser_.is_complete(image)) return skip(image, "is complete");
  return begin(image, std::move(claim));
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

// What goes wrong with one image is told, and the others are made.
template <class Step>
RenderRun::Outcome RenderRun::explained(const PlannedImage& image, const FilmSettings& film,
                                        const Step& step) {
  std::string what;
  std::optional<PixelBox> crop = options_.crop;
  try {
    return step();
  } catch (const std::bad_alloc&) {
    what = lack_of_memory(film);
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
  if (!scene) return scene_is_wrong(image);
  const auto work = std::make_shared<Work>(image, *std::move(scene));
  work->claim = std::move(claim);
  const Outcome outcome = explained(image, work->scene.film, [&] { return start(*work); });
  if (outcome == Outcome::begun) in_hand_.push_back(work);
  return outcome;
}

RenderRun::Outcome RenderRun::start(Work& work) {
  work.needs = needs_within_tolerance(work.scene);
  work.settings = settings_for(options_, threads_->count(), work.scene, work.needs);
  const auto creation_time = source_date_epoch();
  if (!creation_time.ok()) return trouble(creation_time.error());
  work.header = image_header(work.scene, work.settings.wavelengths, recogniser_.origin(*work.image),
                             creation_time.value());
  if (const Outcome found = find_memory(work); found != Outcome::made) return found;
  begin_pixels(work);
  if (options_.resume) resume(work);
  progress_.begin_image(work.image->exr.string(), tile_count(work.scene, work.settings));
  begin_tracing(work);
  threads_->begin(*work.tracing);
  return Outcome::begun;
}

void RenderRun::begin_pixels(Work& work) {
  work.file.reset();
  work.partial = begin_image(work.scene, work.settings);
  work.file = std::make_unique<ImageFile>(work.image->exr, work.header, options_.storage, *work.partial,
                                          helper_ ? &*helper_ : nullptr);
}

void RenderRun::begin_tracing(Work& work) {
  work.tracing = std::make_unique<ImageTracing>(work.scene, work.settings, *work.partial, pause_requested(),
                                                &progress_, work.file.get());
}

bool RenderRun::has_lost_claim(const Work& work) {
  return work.claim != nullptr && work.claim->is_lost();
}

RenderRun::Outcome RenderRun::finish(const std::shared_ptr<Work>& work) {
  ImageFile& file = *work->file;
  while (true) {
    work->statistics.seconds += threads_->finish();
    file.settle();
    if (file.is_lost()) break;
    if (work->partial->is_complete() && !file.is_to_begin_anew()) {
      // The image itself is at hand; where there is another behind it, the snapshot is of that.
      if (in_hand_.size() == 1) take_snapshot_request();
      break;
    }
    if (take_snapshot_request() && !stop_requested() && !has_lost_claim(*work)) snapshot(*work);
    if (stop_requested()) return stop(*work);
    if (file.is_to_begin_anew()) {
      file.begin_anew();
      if (!work->partial->keeps_rows()) begin_tracing(*work);  // what was counted is counted again
    }
    progress_.restart_images();
    threads_->go_on_with(*work->tracing);
  }
  const double seconds = last_seconds_ = work->statistics.seconds;
  work->statistics = work->tracing->statistics();
  work->statistics.seconds = std::max(0.0, seconds - file.seconds() / threads_->count());
  work->tracing.reset();
  if (has_lost_claim(*work)) {
    progress_.say("backlight: warning: " + work->image->exr.string() +
                  ": another process took the claim over, which had expired; it will write the image");
    return Outcome::claimed_by_another;
  }
  return deliver(work);
}

void RenderRun::resume(Work& work) {
  const std::filesystem::path path = partial_path(work.image->exr);
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return;
  const auto read = read_partial(path, recogniser_.identity(*work.image), *work.partial, work.file.get());
  if (!read.ok()) {
    begin_pixels(work);
    progress_.say("backlight: warning: " + read.error() + "; beginning anew");
  } else if (options_.verbosity != Verbosity::quiet) {
    progress_.say("going on with " + path.string());
  }
}

void RenderRun::snapshot(const Work& work) {
  const std::filesystem::path path = partial_path(work.image->exr);
  const auto written = write_partial(path, *work.partial, work.header, work.file.get());
  if (!written.ok()) {
    progress_.say("backlight: warning: " + written.error());  // the image itself may yet find its place
  } else if (options_.verbosity != Verbosity::quiet) {
    progress_.say("wrote the snapshot " + path.string());
  }
}

RenderRun::Outcome RenderRun::stop(const Work& work) {
  const bool behind_another = std::exchange(has_stopped_, true);
  if (behind_another && !work.partial->has_any()) return Outcome::stopped;
  if (has_lost_claim(work)) return Outcome::stopped;  // what another has made by now stays alone
  const std::filesystem::path path = partial_path(work.image->exr);
  if (const auto written = write_partial(path, *work.partial, work.header, work.file.get()); !written.ok())
    return trouble(written.error());
  if (options_.verbosity != Verbosity::quiet) {
    progress_.say("stopped; wrote " + path.string() + ", which --resume finishes");
  }
  return Outcome::stopped;
}

}  // namespace backlight
