// Standard input, output and error, as the shell has left them.
#pragma once

namespace backlight {

/// Takes the places of those that are closed (`>&-`), so that no image gets the number of standard error and
/// messages written into it. Reading and writing them fails as before.
void keep_standard_streams_apart();

/// Whether a descriptor is a pipe that nobody reads any more.
bool has_no_reader(int descriptor);

}  // namespace backlight
