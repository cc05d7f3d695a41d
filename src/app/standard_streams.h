// Standard input, output and error, as the shell has left them.
#pragma once

#include <string>

#include "backlight/base/result.h"

namespace backlight {

/// Takes the places of those that are closed (`>&-`), so that no image gets the number of standard error and
/// messages written into it. Reading and writing them fails as before.
void keep_standard_streams_apart();

/// Whether a descriptor is a pipe that nobody reads any more.
bool has_no_reader(int descriptor);

/// All of the standard input, however long it takes to come. Fails where it cannot be read or is longer than
/// `longest_text`, and when a signal asks to stop before its end.
Result<std::string> read_standard_input();

}  // namespace backlight
