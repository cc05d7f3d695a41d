// Images on their way into their files, and what is told of them.
#include <cstdio>
#include <filesystem>
#include <new>
#include <utility>

#include "backlight/film/display.h"
#include "backlight/film/exposure.h"
#include "backlight/render/image_identity.h"
#include "backlight/render/partial_file.h"
#include "display_words.h"
#include "label_text.h"
#include "picture_layout.h"
#include "render_run.h"

namespace backlight {

RenderRun::Outcome RenderRun::deliver(const std::shared_ptr<Work>& work) {
  work->partial.reset();  // the file has it
  deliveries_.add(
      [this, work]() -> Result<void> {
        try {
          return store(*work);
        } catch (const std::bad_alloc&) {
          work->lacks_memory = true;
          return {};
        }
      },
      [this, work](const Result<void>& stored) -> Result<void> {
        try {
          if (!work->lacks_memory) return conclude(*work, stored);
        } catch (const std::bad_alloc&) {  // for what is told of it
        }
        tell_of_lack(*work);
        return {};
      });
  if (work->image == &images_.back()) deliveries_.wait();  // the end that progress tells is the end
  progress_.end_image();
  return deliveries_.has_failed() ? Outcome::file_trouble : Outcome::made;
}

Result<void> RenderRun::store(Work& work) const {
  const PlannedImage& image = *work.image;
  std::error_code ignored;
  // The PNG of an earlier image must not stand beside this one, should the process end between the two.
  if (!image.png.empty()) std::filesystem::remove(image.png, ignored);
  if (const auto written = work.file->commit(); !written.ok()) return written;
  auto png = complete_png(image);
  if (!png.ok()) return png.failure();
  work.png_lines = std::move(png).value();
  return {};
}

Result<void> RenderRun::conclude(Work& work, const Result<void>& stored) {
  if (stored.ok()) {
    record(work);
    remove_superseded(*work.image);
    tell(work);
  } else {
    trouble(stored.error());
  }
  work.claim.reset();
  return stored;
}

// The other images may have enough.
void RenderRun::tell_of_lack(Work& work) {
  lacked_memory_ = true;
  work.claim.reset();
  progress_.say("backlight: error: " + work.image->exr.string() + ": " + lack_of_memory(work.scene.film));
}

// Images matter more than what is told of them: they are all made, and the exit status tells of the loss.
void RenderRun::record(Work& work) {
  work.record = statistics_json(work.scene, work.needs, work.settings, work.statistics, work.file->faults(),
                                work.image->exr);
  const auto written = statistics_.write(work.record);
  if (!written.ok() && !std::exchange(lost_statistics_, true))
    trouble(written.error() + "; the images are made all the same");
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
  auto displayed = display_image(picture.value().image, transform);
  if (!displayed.ok()) return displayed.failure();
  if (!options_.label.empty()) {
    const auto text = label_text(options_.label, image.exr, picture.value().header);
    if (!text.ok()) return Failure{image.exr.string() + ": " + text.error()};
    PixelBytes& pixels = displayed.value().pixels;
    if (const auto added = add_label(pixels, pixels.height, text.value()); !added.ok())
      return added.failure();
  }
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
  const ImageFaults faults = work.file->faults();
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
  if (statistics.rays.ended > 0) {
    progress_.say(
        "backlight: warning: " + file + ": " + std::to_string(statistics.rays.ended) + " of " +
        std::to_string(statistics.rays.passed_on + statistics.rays.ended) +
        " rays that mirrors and glass pass on end black: they have gone on 'bounces' times ([film], " +
        std::to_string(work.scene.film.bounces) + ")");
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

std::string RenderRun::lack_of_memory(const FilmSettings& film) {
  return "not enough memory for an image of " + std::to_string(film.width) + "x" +
         std::to_string(film.height) + " pixels; render it in parts with --crop";
}

}  // namespace backlight
