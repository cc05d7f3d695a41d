// The words of --help.
#pragma once

#include <string>

namespace backlight {

/// What 'backlight --help' prints.
std::string general_help();

/// An option with its meaning in a column beside it, wrapped at 100 characters, with a newline.
std::string help_row(std::string option, const std::string& meaning);

}  // namespace backlight
