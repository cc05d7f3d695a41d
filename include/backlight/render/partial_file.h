// Images that were put aside before their last pixel.
#pragma once

#include <filesystem>
#include <string>

#include "backlight/base/result.h"
#include "backlight/film/exr.h"
#include "backlight/render/render.h"

namespace backlight {

/// "shot.0007.exr" -> "shot.0007.partial.exr"
std::filesystem::path partial_path(const std::filesystem::path& exr);

/// Writes what is done of an image: a valid EXR with all channels in float, so that nothing is rounded that
/// the finished file would not round, and a channel `rendered.V` (for each view) that is 1 where the pixel is
/// final. Elsewhere all channels are 0, alpha too. `header` is that of the finished image; the file says
/// `backlight/complete = 0`.
Result<void> write_partial(const std::filesystem::path& path, const PartialImage& partial,
                           const ExrHeader& header);

/// Reads such a file into `partial`, which has been begun for the wanted image. Fails, and leaves it as it
/// is, if the file cannot be read, has another identity than `identity`, or other channels or pixels.
Result<void> read_partial(const std::filesystem::path& path, const std::string& identity,
                          PartialImage& partial);

}  // namespace backlight
