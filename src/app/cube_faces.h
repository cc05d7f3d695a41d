// The six faces of a cubemap (camera/projection.h), each in a file of its own.
#pragma once

#include <filesystem>

#include "backlight/base/result.h"
#include "backlight/film/exr.h"
#include "backlight/film/png.h"

namespace backlight {

/// Fails if the header tells that the image is of another projection, or if it has not the shape of six
/// faces, or not all of them.
Result<void> require_cubemap(const std::filesystem::path& file, const ExrInfo& info);

/// NAME.right.png, left, up, down, front, back for NAME.png. The picture is one of six faces.
Result<void> write_faces(const std::filesystem::path& png, const PixelBytes& cube);

/// The same as OpenEXR files, with all channels, of an image that require_cubemap() takes. The header of each
/// is that of a perspective of 90 degrees, and tells in `backlight/face` which it is; no identity of a
/// render.
Result<void> write_faces(const std::filesystem::path& exr, const ExrPicture& cube);

}  // namespace backlight
