// System calls that a signal came in between.
#pragma once

#include <cerrno>

namespace backlight {

/// What `call` returns, which is made once more whenever a signal has interrupted it (below 0, and EINTR).
template <class Call>
auto unless_interrupted(const Call& call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

}  // namespace backlight
