// libFuzzer entry: any bytes are a scene, or errors that say where.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "backlight/scene/compile.h"
#include "backlight/scene/explain.h"
#include "backlight/scene/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace backlight;
  const std::string text(reinterpret_cast<const char*>(data), size);
  // Large copies and star fields are right, but no use here.
  const bool large = text.find("count") != std::string::npos;
  ReadResult read = read_scene_text(text, "fuzzed.toml", {}, "/nonexistent");
  std::optional<Scene> scene;
  ResourceCache cache;
  if (read.description && !large) scene = compile(*read.description, {}, cache, read.diagnostics);
  if (!large && scene.has_value() == read.diagnostics.has_errors()) std::abort();
  if (!read.description && !read.diagnostics.has_errors()) std::abort();
  for (const Diagnostic& diagnostic : read.diagnostics.all()) {
    if (diagnostic.message.empty() || format(diagnostic).empty()) std::abort();
  }
  if (scene && explain(*read.description, *scene, needs_of(*scene)).empty()) std::abort();
  return 0;
}
