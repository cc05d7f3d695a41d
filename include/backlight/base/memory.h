// The memory of the process as the system sees it.
#pragma once

namespace backlight {

/// Gives the memory that has been freed back to the system, where the C library can. For use after many small
/// things have been freed that leave gaps which what follows does not fit into; takes milliseconds.
void return_freed_memory();

}  // namespace backlight
