// From a scene file to its description.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "backlight/base/diagnostics.h"
#include "backlight/scene/description.h"

namespace backlight {

struct ReadResult {
  /// Empty when a file cannot be read or is not TOML. Present in spite of other errors, so that compile()
  /// can add what is wrong with the values; it then never returns a scene.
  std::optional<Description> description;
  Diagnostics diagnostics;
  bool unreadable = false;  ///< the scene file itself could not be read
};

/// Reads a scene file, merges what it includes, applies overrides of the form "path=value", and checks keys,
/// types, names and references. `path` is shown in diagnostics as it is given.
///
/// An override's path is a dotted key ("camera.fov", "frame.tram.velocity"); an element of a list of tables
/// is named by its `name` or by its number from 1 ("object.tram.velocity", "light.1.intensity"). Its value is
/// TOML; a bare word or formula is taken as a string ("camera.time=2*t").
ReadResult read_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});

/// The same for a text that is not in a file. Relative paths in it start at `folder`.
ReadResult read_scene_text(const std::string& text, const std::string& name = "scene.toml",
                           const std::vector<std::string>& overrides = {},
                           const std::filesystem::path& folder = {});

/// The diagnostics in the order of their places: file by file as they were read, line by line.
Diagnostics in_file_order(const Diagnostics& diagnostics, const Description& description);

}  // namespace backlight
