#include "scene_session.h"

#include <utility>

#include "backlight/base/memory.h"
#include "backlight/scene/reader.h"
#include "exit_codes.h"
#include "messages.h"
#include "signals.h"
#include "standard_streams.h"

namespace backlight {

namespace {

ReadResult read_scene_of(const SceneOptions& options) {
  if (!is_standard_input(options.file)) return read_scene(options.file, options.overrides);
  const auto text = read_standard_input();
  if (text.ok()) return read_scene_text(text.value(), "<stdin>", options.overrides);
  ReadResult result;
  result.unreadable = true;
  result.diagnostics.error({}, text.error());
  return result;
}

}  // namespace

SceneSession::SceneSession(const SceneOptions& options) {
  ReadResult result = read_scene_of(options);
  found_by_reading_ = std::move(result.diagnostics);
  if (result.description) {
    description_.emplace(*std::move(result.description));
    return;
  }
  print(found_by_reading_);
  exit_code_ = result.unreadable ? exit_file_trouble : exit_scene_wrong;
  if (stop_requested()) exit_code_ = exit_stopped + stop_signal();
}

std::optional<Scene> SceneSession::compile(const ImageRequest& request) {
  if (!compiler_) compiler_.emplace(*description_, cache_, images_);
  Diagnostics diagnostics = found_by_reading_;
  std::optional<Scene> scene = compiler_->compile(request, diagnostics);
  if (!scene) exit_code_ = exit_scene_wrong;
  if (!scene || !warnings_are_printed_) print(in_file_order(diagnostics, *description_));
  warnings_are_printed_ = true;
  if (scene && images_ == SceneCompiler::Images::one) forget_contents();
  return scene;
}

// The description of a hundred thousand spheres is as large as all that is made of it. What identifies the
// image (its film, camera and time) stays.
void SceneSession::forget_contents() {
  std::size_t text = 0;
  for (const auto& source : description_->sources) text += source->text.size();
  compiler_.reset();
  description_->forget_contents();
  return_freed_memory(text);
}

bool SceneSession::check_camera_path(const ImageRequest& request) {
  Diagnostics diagnostics;
  backlight::check_camera_path(*description_, request, diagnostics);
  if (!diagnostics.has_errors()) return true;
  exit_code_ = exit_scene_wrong;
  print(diagnostics);
  return false;
}

}  // namespace backlight
