// Words for a picture, with what the image's header tells in them.
#pragma once

#include <filesystem>
#include <string>

#include "backlight/base/result.h"
#include "backlight/film/exr.h"

namespace backlight {

/// `pattern` with each {name} replaced: {file} by the image's file name without its ending, {params.NAME} by
/// a parameter of the scene, and others by the header's "backlight/NAME": {time}, {frame}, {camera},
/// {scene}... Numbers are rounded to 6 significant digits, or to N decimals by {name:.N}. "{{" is a brace.
/// Fails on a name that the image does not tell, and lists those that it does.
Result<std::string> label_text(const std::string& pattern, const std::filesystem::path& file,
                               const ExrHeader& header);

}  // namespace backlight
