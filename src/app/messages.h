// What the commands say on stderr.
#pragma once

#include <string_view>

#include "backlight/base/diagnostics.h"

namespace backlight {

/// "backlight: error: ..."
void print_error(std::string_view message);
void print_warning(std::string_view message);

/// All diagnostics, and how many there are.
void print(const Diagnostics& diagnostics);

}  // namespace backlight
