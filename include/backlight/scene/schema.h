// What is made from the table of keys (keys.h) for editors and readers.
#pragma once

#include <string>

namespace backlight {

/// The JSON Schema (draft 2020-12) of a scene file, for editors with completion and checks of TOML.
std::string json_schema();

/// docs/scene-reference.md: every table and key of the scene file, in Markdown.
std::string reference_markdown();

}  // namespace backlight
