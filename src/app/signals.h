// Being asked to stop: Ctrl-C, a batch system's SIGTERM, a closed terminal.
#pragma once

#include <atomic>

namespace backlight {

/// From now on SIGINT, SIGTERM and SIGHUP turn stop_requested() true; a second one ends the process at once,
/// with exit code 128 + its number. A signal that was ignored (nohup) stays ignored. Files beyond a size
/// limit become ordinary write errors instead of SIGXFSZ.
void catch_stop_signals();

/// Turns true at the first signal, and stays so.
const std::atomic<bool>& stop_requested();

/// The signal that came first, or 0.
int stop_signal();

}  // namespace backlight
