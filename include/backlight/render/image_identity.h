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

/// SHA-256 (hexadecimal) of all that decides the pixels of an image: the program's version, the bytes of the
/// scene and its includes, the contents of the textures, spectra and star catalogues that it names,
/// overrides, camera, instant and film. Not of threads and file names, nor of the crop and the storage, which
/// the file itself tells: parts of an image have the identity of the whole. Known before anything is traced.
///
/// An option that changes pixels must be in here: a file made with another value of it is another image.
std::string image_identity(const ImageOrigin& origin, const std::vector<std::string>& resource_digests,
                           const ImageFacts& facts);

/// Whether the file is there, whole, complete (`backlight/complete` is 1), of this identity, has the pixels
/// of `crop` (of the whole image if there is none), and is stored as asked for. A header is read; the pixels
/// only of a file whose colour is float though `storage` is automatic: there must be a value beyond half
/// among them.
bool is_complete_image(const std::filesystem::path& file, const std::string& identity,
                       const std::optional<PixelBox>& crop, ColourStorage storage);

}  // namespace backlight
