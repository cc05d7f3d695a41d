// Which images a comparison is about.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "backlight/base/result.h"

namespace backlight {

/// An image's place on both sides; a side where it does not exist has an empty path.
struct ImagePair {
  std::string name;  ///< as reports call it: the path within the folders, or the new file's name
  std::filesystem::path reference;
  std::filesystem::path now;
  std::filesystem::path reference_place;  ///< where the reference is or would be: for --update
};

/// Two files, or all .exr files in two folders and below, by their paths within them, sorted; hidden files
/// and folders apart. Fails if a path does not exist, or if one is a folder and the other is not. With
/// `update` the reference need not exist yet.
Result<std::vector<ImagePair>> pairs_of(const std::filesystem::path& reference,
                                        const std::filesystem::path& now, bool update);

}  // namespace backlight
