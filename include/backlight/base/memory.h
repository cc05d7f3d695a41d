// The memory of the process as the system sees it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace backlight {

/// Gives the memory that has been freed back to the system, where the C library can. For use after many small
/// things have been freed that leave gaps which what follows does not fit into. It takes a moment: with less
/// than a megabyte of `bytes` it does nothing.
void return_freed_memory(std::size_t bytes);

/// How many bytes more the process may take, and who says so.
struct MemoryLeft {
  std::uint64_t bytes = 0;
  std::string where;  ///< "free on this machine", "left in the control group", "left by ulimit -v"
};

/// The least of what the machine has available (with its free swap space), what the control groups of the
/// process (versions 1 and 2) leave, caches that can be dropped not counted, and what RLIMIT_AS leaves.
/// Nothing where the system tells none of them. `root` is where /proc and /sys are, for tests.
std::optional<MemoryLeft> memory_left(const std::filesystem::path& root = "/");

/// "1.5 GiB", "640 MiB", "3 KiB".
std::string memory_words(std::uint64_t bytes);

}  // namespace backlight
