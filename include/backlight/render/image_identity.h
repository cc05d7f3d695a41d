// What an image is made from, as one number: by it a file is recognised as the image that is wanted.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "backlight/film/exr.h"
#include "backlight/render/image_header.h"
#include "backlight/scene/compile.h"

namespace backlight {

/// The header attribute that holds it.
inline constexpr const char* identity_attribute = "backlight/identity";

/// SHA-256 (hexadecimal) of all that decides the bytes of an image: the program's version, the bytes of the
/// scene and its includes, the contents of the textures, spectra and star catalogues that it names,
/// overrides, camera, instant, film, crop and storage. Not of threads, nor of file names. Known before
/// anything is traced.
///
/// An option that changes pixels must be in here: a file made with another value of it is another image.
std::string image_identity(const ImageOrigin& origin, const std::vector<std::string>& resource_digests,
                           const ImageFacts& facts, ColourStorage storage);

/// Whether the file is there, whole, complete (`backlight/complete` is 1), of this identity, and has the
/// pixels of `crop` (of the whole image if there is none).
bool is_complete_image(const std::filesystem::path& file, const std::string& identity,
                       const std::optional<PixelBox>& crop);

}  // namespace backlight
