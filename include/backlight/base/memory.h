// The memory of the process as the system sees it.
#pragma once

#include <cstddef>

namespace backlight {

/// Gives the memory that has been freed back to the system, where the C library can. For use after many small
/// things have been freed that leave gaps which what follows does not fit into. It takes a moment: with less
/// than a megabyte of `bytes` it does nothing.
void return_freed_memory(std::size_t bytes);

}  // namespace backlight
