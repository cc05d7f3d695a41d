// Between our description of a picture and OpenEXR's header.
#pragma once

#include <ImfHeader.h>

#include "backlight/film/exr.h"

namespace backlight {

/// Throws std::exception on an attribute that cannot be written.
Imf::Header to_imf(const ImageLayout& layout, const ExrHeader& description);

/// One part. Throws std::exception on windows that no picture has.
ExrInfo from_imf(const Imf::Header& header);

}  // namespace backlight
