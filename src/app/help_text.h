// The words of --help.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "manual.h"

namespace backlight {

/// What 'backlight --help' prints.
std::string general_help();

/// What the program is, what it returns to the shell, and which environment variables it reads: name and
/// meaning.
std::string program_text();
std::string exit_status_text();
std::vector<std::pair<std::string, std::string>> environment_variables();

/// What 'backlight COMMAND --help' prints: names, values and meanings in columns, wrapped at 100 characters.
std::string help_of(const CommandManual& command);

}  // namespace backlight
