// Putting an image together again that was rendered in parts.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "backlight/film/exr.h"

namespace backlight {

/// One file of an image rendered in parts (`--crop`): its data window says which pixels it has.
struct ImagePart {
  std::filesystem::path file;
  ExrInfo info;
};

/// What is wrong with the parts as their headers tell it, or nothing: they are not of one image (another
/// scene, other settings, another frame), one of them is not complete, the colours of some are stored as
/// float and those of others as half, or pixels are in none of them. A sentence with the files it is about.
std::string misfit_of(const std::vector<ImagePart>& parts);

/// How an assembly ended.
struct Assembly {
  enum class End {
    written,
    misfit,       ///< the parts do not make an image: misfit_of, or a pixel differs between two of them
    file_trouble  ///< a file cannot be read or written
  };
  End end = End::written;
  std::string message;  ///< empty when written
};

/// Writes the image that the parts make: the bytes are those of the image rendered as a whole. Parts may
/// overlap where they have the same bits. Holds a band of rows in memory, not the image.
///
/// Colour is stored as in the parts. With `narrow`, colour that is stored as float becomes half if all values
/// of it are in half's range: as ColourStorage::automatic has it, which is a decision about the whole image.
/// Nothing is left behind on failure, and a file that was at `output` is as it was.
Assembly assemble_exr(const std::filesystem::path& output, const std::vector<ImagePart>& parts, bool narrow);

}  // namespace backlight
