// What a damaged header would make OpenEXR allocate, found out before it sees it.
#pragma once

#include <ImfIO.h>

#include <cstdint>

#include "backlight/film/exr.h"

namespace backlight {

/// Walks through the attributes of the headers that begin at the stream's position, and goes back there.
/// Throws std::runtime_error where one of them is longer than what is left of the file: OpenEXR makes room
/// for an attribute before it reads it.
void check_attributes(Imf::IStream& stream, std::uint64_t file_size, bool several_parts);

/// Throws std::runtime_error where the picture has more pixels than a file of this size can hold, however it
/// is compressed.
void check_size(const ImageLayout& layout, std::uint64_t file_size);

}  // namespace backlight
