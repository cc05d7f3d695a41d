// Scenes from texts, for tests.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "backlight/scene/compile.h"
#include "backlight/scene/reader.h"

namespace backlight::testing_scenes {

/// A camera, for scenes in which it does not matter.
inline const std::string camera = "[camera]\nposition = [0, 0, -5]\n";

inline std::string all_messages(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics.all()) text += format(diagnostic) + "\n";
  return text;
}

/// What is wrong with a scene: all messages, one after the other.
inline std::string mistakes(const std::string& text, const ImageRequest& request = {},
                            const std::vector<std::string>& overrides = {}) {
  ReadResult read = read_scene_text(text, "test.toml", overrides);
  ResourceCache cache;
  if (read.description) compile(*read.description, request, cache, read.diagnostics);
  return all_messages(read.diagnostics);
}

/// The scene of a text that has nothing wrong; an empty one, and a failed test, otherwise.
inline Scene compiled(const std::string& text, const ImageRequest& request = {},
                      const std::vector<std::string>& overrides = {}, const std::string& folder = {}) {
  ReadResult read = read_scene_text(text, "test.toml", overrides, folder);
  ResourceCache cache;
  std::optional<Scene> scene;
  if (read.description) scene = compile(*read.description, request, cache, read.diagnostics);
  EXPECT_TRUE(scene.has_value()) << all_messages(read.diagnostics);
  return scene ? std::move(*scene) : Scene{};
}

}  // namespace backlight::testing_scenes
