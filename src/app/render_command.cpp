#include <algorithm>
#include <iostream>
#include <string>
#include <utility>

#include "backlight/base/files.h"
#include "backlight/base/json_text.h"
#include "backlight/render/partial_file.h"
#include "commands.h"
#include "exit_codes.h"
#include "label_text.h"
#include "messages.h"
#include "render_run.h"

namespace backlight {
namespace {

// Better now than after an hour of rendering.
Result<void> try_output(const std::filesystem::path& path) {
  auto file = AtomicFile::create(path);
  if (!file.ok()) return file.failure();
  file.value().abandon();
  return {};
}

// Whether there is anything to write.
bool all_are_complete(const std::vector<PlannedImage>& images, const RenderOptions& options,
                      const ImageRecogniser& recogniser) {
  std::error_code error;
  return options.skip_existing && std::ranges::all_of(images, [&](const PlannedImage& image) {
           return recogniser.is_complete(image) &&
                  (image.png.empty() || std::filesystem::exists(image.png, error));
         });
}

// What would be written goes to stdout, for scripts; what would be skipped or resumed is told on stderr.
void print_files(const std::vector<PlannedImage>& images, const Scene& first, const RenderOptions& options,
                 const ImageRecogniser& recogniser) {
  std::error_code error;
  for (const PlannedImage& image : images) {
    if (options.skip_existing && recogniser.is_complete(image)) {
      if (options.verbosity != Verbosity::quiet)
        std::cerr << image.exr.string() << "  is complete: would be skipped\n";
      continue;
    }
    const std::filesystem::path partial = partial_path(image.exr);
    if (options.resume && options.verbosity != Verbosity::quiet && std::filesystem::exists(partial, error)) {
      std::cerr << partial.string() << "  would be gone on with\n";
    }
    const std::string number =
        options.list_frames ? json_number(image.request.frame.value_or(first.frame)) + "\t" : "";
    std::cout << number << image.exr.string() << '\n';
    if (!image.png.empty()) std::cout << number << image.png.string() << '\n';
  }
}

// A name that the images will not tell is better told of before they are rendered.
Result<void> try_label(const RenderOptions& options, const PlannedImage& image, const Scene& scene,
                       const ImageRecogniser& recogniser) {
  if (options.label.empty()) return {};
  const ExrHeader header = image_header(scene, 0, recogniser.origin(image), std::nullopt);
  const auto text = label_text(options.label, image.exr, header);
  return text.ok() ? Result<void>() : Result<void>(Failure{"--label: " + text.error()});
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
  SceneSession session(options.scene);
  if (session.exit_code() != exit_success) return session.exit_code();
  const auto images = plan_images(options, session.frames());
  if (!images.ok()) return usage_trouble(images.error());
  const bool nothing_planned = images.value().empty();  // [animation] is wrong: compile() says how
  if (images.value().size() <= 1) session.expect_one_image();
  auto first = session.compile(nothing_planned ? options.scene.request : images.value().front().request);
  if (!first && images.value().size() > 1) {
    print_error(images.value().front().exr.string() + ": not made, the scene is wrong in frame " +
                std::to_string(images.value().front().request.frame.value_or(1)));
  }
  if (!first || nothing_planned) return exit_scene_wrong;

  const FilmSettings& film = first->film;
  if (options.crop && (options.crop->x1 > film.width || options.crop->y1 > film.height)) {
    return usage_trouble("--crop: reaches beyond the image, which is " + std::to_string(film.width) + "x" +
                         std::to_string(film.height));
  }
  auto recogniser = ImageRecogniser::of(options, session);
  if (!recogniser.ok()) return file_trouble(recogniser.error());
  if (const auto tried = try_label(options, images.value().front(), *first, recogniser.value()); !tried.ok())
    return usage_trouble(tried.error());
  if (options.dry_run || options.list_frames) {
    print_files(images.value(), *first, options, recogniser.value());
    return exit_success;
  }
  // Where nothing is to be written, the folder may be one that cannot be written to.
  const bool nothing_to_do = all_are_complete(images.value(), options, recogniser.value());
  if (const auto tried = try_output(images.value().front().exr); !tried.ok() && !nothing_to_do)
    return file_trouble(tried.error());
  auto statistics = StatisticsFile::open(options.statistics, options.skip_existing);
  if (!statistics.ok()) {
    if (!nothing_to_do) return file_trouble(statistics.error());
    statistics = StatisticsFile();
  }
  return RenderRun(options, session, recogniser.value(), images.value(), std::move(statistics).value())
      .run(std::move(*first));
}

}  // namespace backlight
