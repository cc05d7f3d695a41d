// What is done with a mutated input: all that the program does with such a file, in this process.
#pragma once

#include <filesystem>
#include <string>

namespace backlight::fuzz {

/// What an input is.
enum class Kind { scene, image, texture, table, mesh };

/// Reads the input from `file` as its kind, and goes on with what comes of it: a scene is compiled and a tiny
/// image of it rendered, an image is shown, compared, assembled and resumed. Relative paths of a scene start
/// at `folder`. Aborts where what came out contradicts itself.
void try_input(Kind kind, const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace backlight::fuzz
