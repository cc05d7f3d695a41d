#include "rendering.h"

#include <filesystem>
#include <stdexcept>

#include "backlight/camera/projection.h"
#include "backlight/render/wavelength_estimate.h"
#include "backlight/scene/compile.h"
#include "backlight/scene/reader.h"

namespace backlight::test {
namespace {

std::string text_of(const Diagnostics& diagnostics) {
  std::string all;
  for (const Diagnostic& d : diagnostics.all()) all += format(d) + "\n";
  return all;
}

Rendering rendered(std::optional<Scene> scene, const Diagnostics& diagnostics, const RenderChoices& choices) {
  if (!scene) throw std::runtime_error(text_of(diagnostics));
  RenderSettings settings;
  settings.threads = choices.threads;
  settings.crop = choices.crop;
  settings.wavelengths = choices.wavelengths.value_or(needs_within_tolerance(*scene).wavelengths);
  settings.path = choices.path;
  settings.instructions = choices.instructions;
  settings.pieces = choices.pieces;
  const std::atomic<bool> stop{false};
  std::optional<RenderedImage> result = render_image(*scene, settings, stop, nullptr);
  return {std::move(*scene), std::move(result->image), result->statistics};
}

Rendering render(ReadResult read, const RenderChoices& choices) {
  if (!read.description || read.diagnostics.has_errors()) throw std::runtime_error(text_of(read.diagnostics));
  ImageRequest request;
  request.time = choices.time;
  request.frame = choices.frame;
  ResourceCache resources;
  Diagnostics diagnostics;
  std::optional<Scene> scene = compile(*read.description, request, resources, diagnostics);
  return rendered(std::move(scene), diagnostics, choices);
}

}  // namespace

double Rendering::at(const char* channel, int x, int y) const {
  const int index = image.find_channel(channel);
  if (index < 0) throw std::runtime_error(std::string("no channel ") + channel);
  return image.at(static_cast<std::size_t>(index), x, y);
}

Vec3 Rendering::direction(int x, int y) const {
  return direction_at(scene.camera.lens, {x + 0.5, y + 0.5}).value_or(Vec3{0.0});
}

bool Rendering::is_inside(int x, int y) const {
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (id(x + dx, y + dy) != id(x, y)) return false;
  return true;
}

Rendering render_text(const std::string& text, const RenderChoices& choices) {
  return render(read_scene_text(text, "scene.toml", choices.overrides, BACKLIGHT_SOURCE_DIR), choices);
}

std::vector<Rendering> render_sequence(const std::string& text, const std::vector<int>& frames) {
  const ReadResult read = read_scene_text(text, "scene.toml", {}, BACKLIGHT_SOURCE_DIR);
  if (!read.description || read.diagnostics.has_errors()) throw std::runtime_error(text_of(read.diagnostics));
  ResourceCache resources;
  SceneCompiler compiler(*read.description, resources, SceneCompiler::Images::several);
  std::vector<Rendering> all;
  for (const int frame : frames) {
    ImageRequest request;
    request.frame = frame;
    Diagnostics diagnostics;
    std::optional<Scene> scene = compiler.compile(request, diagnostics);
    all.push_back(rendered(std::move(scene), diagnostics, {}));
  }
  return all;
}

Rendering render_file(const std::string& path, const RenderChoices& choices) {
  return render(read_scene(std::filesystem::path(BACKLIGHT_SOURCE_DIR) / path, choices.overrides), choices);
}

std::string film(int width, int height) {
  return "[film]\nresolution = [" + std::to_string(width) + ", " + std::to_string(height) +
         "]\nsamples = 1\naovs = [\"Z\", \"doppler\", \"emissionTime\", \"properTime\", \"P\", \"N\", "
         "\"objectId\"]\n";
}

}  // namespace backlight::test
