// What a file says about how its image was made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "backlight/film/exr.h"
#include "backlight/scene/scene.h"

namespace backlight {

/// Where an image comes from, besides the scene itself.
struct ImageOrigin {
  std::string software;                ///< name and version of the program
  std::string scene_file;              ///< file name, without the folder
  std::string scene_sha256;            ///< of the scene file and what it includes
  std::vector<std::string> overrides;  ///< "path=value"
  std::string identity;                ///< image_identity.h
};

/// Of a scene of more objects, a file does not tell the names and velocities, with which its header would be
/// heavy.
inline constexpr std::size_t most_named_objects = 4096;

/// The header of an image (docs/command-line.md lists the attributes). The clock goes in only as
/// `creation_time`, and nothing that differs between
/// parts of an image or tells how often it was put aside: the same scene gives the same bytes.
ExrHeader image_header(const Scene& scene, int wavelengths, const ImageOrigin& origin,
                       std::optional<std::int64_t> creation_time);

/// Effects as they would be written in a scene file, with commas between.
std::string effects_text(const Effects& effects);

}  // namespace backlight
