#include "standard_streams.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <initializer_list>

#include "backlight/base/files.h"
#include "signals.h"

namespace backlight {

// /dev/full, since writing fails there for those too who open it anew as /dev/stdout.
void keep_standard_streams_apart() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0) continue;
    const int mode = descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    // The lowest number that is free: this one.
    if (open("/dev/full", mode) < 0) static_cast<void>(open("/dev/null", mode));
  }
}

bool has_no_reader(int descriptor) {
  pollfd asked{descriptor, POLLOUT, 0};
  return poll(&asked, 1, 0) == 1 && (asked.revents & POLLERR) != 0;
}

Result<std::string> read_standard_input() {
  const auto failure = [](const std::string& why) { return Failure{"cannot read standard input: " + why}; };
  constexpr int moment = 200;  // ms: so long a signal to stop may wait for its answer
  std::string text;
  std::array<char, std::size_t{1} << 16U> block{};
  while (!stop_requested()) {
    pollfd waiting{STDIN_FILENO, POLLIN, 0};
    const int ready = poll(&waiting, 1, moment);
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    const ssize_t count = read(STDIN_FILENO, block.data(), block.size());
    if (count == 0) return text;
    if (count > 0) text.append(block.data(), static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR && errno != EAGAIN) return failure(std::strerror(errno));
    if (text.size() > longest_text)
      return failure("it is longer than " + std::to_string(longest_text >> 20U) + " MiB");
  }
  return failure("stopped by a signal");
}

}  // namespace backlight
