#include <algorithm>
#include <iostream>
#include <vector>

#include "backlight/base/memory.h"
#include "backlight/render/image_memory.h"
#include "backlight/render/wavelength_estimate.h"
#include "backlight/scene/explain.h"
#include "commands.h"
#include "exit_codes.h"
#include "messages.h"
#include "scene_session.h"

namespace backlight {
namespace {

// All of a short animation, and as many evenly spaced frames of a long one, its last among them.
std::vector<int> frames_to_check(const std::vector<int>& frames) {
  constexpr std::size_t most = 100;
  if (frames.size() <= most) return frames;
  std::vector<int> some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(frames[i * (frames.size() - 1) / (most - 1)]);
  return some;
}

// What rendering takes, and a warning where that is not there.
std::string memory_line(const Scene& scene, const RenderSettings& settings) {
  const std::uint64_t surfaces = surface_bytes(scene);
  const std::uint64_t textures = texture_bytes(scene);
  std::string text = "  memory     " + memory_words(image_bytes(scene, settings)) + " for the pixels";
  if (surfaces > 0) text += ", " + memory_words(surfaces) + " for the surfaces";
  if (textures > 0) text += ", " + memory_words(textures) + " for the textures";
  return text + '\n';
}

// What an image takes over from the one before, unchanged.
std::string reuse_line(const CompileCounts& counts) {
  const auto share = [](std::size_t reused, std::size_t made, const char* what) {
    return std::to_string(reused) + " of " + std::to_string(reused + made) + ' ' + what;
  };
  return "  reuse      from image to image " +
         share(counts.surfaces_reused, counts.surfaces_made, "surfaces") + ", " +
         share(counts.materials_reused, counts.materials_made, "materials") + '\n';
}

void warn_of_shortage(const Scene& scene, const RenderSettings& settings) {
  const auto left = memory_left();
  if (!left) return;
  if (const std::string shortage = memory_shortage(scene, settings, *left); !shortage.empty())
    print_warning(shortage);
}

}  // namespace

int run(const CheckOptions& options) {
  SceneSession session(options.scene);
  if (session.exit_code() != exit_success) return session.exit_code();
  ImageRequest outline = options.scene.request;
  outline.outline = true;
  const auto scene = session.compile(outline);
  if (!scene) return session.exit_code();

  const std::vector<int> frames = session.frames();
  const std::vector<int> checked = frames_to_check(frames);
  CompileCounts last;
  for (const int frame : checked) {
    ImageRequest request = outline;
    request.frame = frame;
    if (const auto image = session.compile(request)) {
      last = image->counts;
      continue;
    }
    std::cerr << "in frame " << frame << '\n';
    return session.exit_code();
  }
  if (!session.check_camera_path(options.scene.request)) return session.exit_code();
  warn_of_shortage(*scene, {});
  if (options.verbosity == Verbosity::quiet) return exit_success;
  std::cout << explain(session.description(), *scene, needs_within_tolerance(*scene))
            << memory_line(*scene, {});
  if (frames.size() > 1) {
    std::cout << reuse_line(last) << "No mistakes in " << checked.size() << " of its " << frames.size()
              << " frames.\n";
  }
  return exit_success;
}

}  // namespace backlight
