// Images that were put aside before their last pixel.
#pragma once

#include <filesystem>
#include <string>

#include "backlight/base/result.h"
#include "backlight/film/exr.h"
#include "backlight/render/image_file.h"
#include "backlight/render/partial_image.h"

namespace backlight {

/// "shot.0007.exr" -> "shot.0007.partial.exr"
std::filesystem::path partial_path(const std::filesystem::path& exr);

/// Writes what is done of an image: a valid EXR with all channels in float, and a channel `rendered.V` (for
/// each view) that is 1 where the pixel is final. Elsewhere all channels are 0, alpha too. `header` is that
/// of the finished image; the file says `backlight/complete = 0`. Rows that the image has released are those
/// of `file`, which nobody uses meanwhile; colour is then as that file has it, rounded to half or not, and
/// `backlight/colour` says which: "half" or "float". Nothing is rounded that the finished file would not
/// round.
Result<void> write_partial(const std::filesystem::path& path, const PartialImage& partial,
                           const ExrHeader& header, ImageFile* file = nullptr);

/// Reads such a file into `partial`, which has been begun for the wanted image, and from there into its
/// `file`. Fails, and leaves both as they are, if the file has another identity than `identity`, or other
/// channels or pixels. If it cannot be read, rows before that are there.
Result<void> read_partial(const std::filesystem::path& path, const std::string& identity,
                          PartialImage& partial, ImageFile* file = nullptr);

}  // namespace backlight
