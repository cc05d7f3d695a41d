// Memory that is about to be filled.
#pragma once

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <cstddef>
#include <cstdint>
#include <span>

namespace backlight {

/// Takes it from the system at once, where that is possible: page by page, each when it is first written to,
/// would cost more than what is to stand in it.
template <class T>
void take_room([[maybe_unused]] std::span<T> room) {
#if defined(MADV_POPULATE_WRITE)
  constexpr std::size_t page = 4096;
  char* const begin = reinterpret_cast<char*>(room.data());
  const std::size_t before = reinterpret_cast<std::uintptr_t>(begin) % page;
  static_cast<void>(madvise(begin - before, before + room.size_bytes(), MADV_POPULATE_WRITE));
#endif
}

}  // namespace backlight
