// The words of --help.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace backlight {

/// What 'backlight --help' prints.
std::string general_help();

/// What the program is, what it returns to the shell, and which environment variables it reads: name and
/// meaning.
std::string program_text();
std::string exit_status_text();
std::vector<std::pair<std::string, std::string>> environment_variables();

/// An option with its meaning in a column beside it, wrapped at 100 characters, with a newline.
std::string help_row(std::string option, const std::string& meaning);

}  // namespace backlight
