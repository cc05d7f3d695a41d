// Why a run does not go on, or an image is not begun: its scene is wrong, or it does not fit into memory.
#include <stdexcept>
#include <string>

#include "backlight/base/memory.h"
#include "backlight/render/image_memory.h"
#include "render_run.h"

namespace backlight {

RenderRun::Outcome RenderRun::trouble(const std::string& what) {
  progress_.say("backlight: error: " + what);
  return Outcome::file_trouble;
}

// What is wrong has been told, but not of which image.
RenderRun::Outcome RenderRun::scene_is_wrong(const PlannedImage& image) {
  const std::string frame =
      image.request.frame ? " in frame " + std::to_string(*image.request.frame) : std::string();
  progress_.say("backlight: error: " + image.exr.string() + ": not made, the scene is wrong" + frame);
  return Outcome::failed;
}

// Where memory is short, the images before this one are finished first, and give theirs back.
RenderRun::Outcome RenderRun::find_memory(const Work& work) {
  constexpr std::uint64_t worth_a_look = std::uint64_t{64} << 20U;
  if (image_bytes(work.scene, work.settings) < worth_a_look) return Outcome::made;
  const auto shortage = [&work] {
    const auto left = memory_left();
    return left ? memory_shortage(work.scene, work.settings, *left) : std::string();
  };
  if (shortage().empty()) return Outcome::made;
  const Outcome before = finish_all();
  if (before > Outcome::failed) return before;
  some_failed_ = some_failed_ || before == Outcome::failed;
  deliveries_.wait();
  if (const std::string text = shortage(); !text.empty()) throw std::runtime_error(text);
  return Outcome::made;
}

}  // namespace backlight
