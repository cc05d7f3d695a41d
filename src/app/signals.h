// Being asked to stop: Ctrl-C, a batch system's SIGTERM, a closed terminal.
#pragma once

#include <atomic>

namespace backlight {

/// From now on SIGINT, SIGTERM and SIGHUP turn stop_requested() true; a second one ends the process at once,
/// with exit code 128 + its number. SIGUSR1 asks for a snapshot. A signal that was ignored (nohup) stays
/// ignored. Files beyond a size limit become ordinary write errors instead of SIGXFSZ.
void catch_stop_signals();

/// Turns true at the first signal, and stays so.
const std::atomic<bool>& stop_requested();

/// Turns true when tracing is to pause: at the first signal to stop, and for a snapshot.
const std::atomic<bool>& pause_requested();

/// Whether a snapshot was asked for since the last call.
bool take_snapshot_request();

/// The signal to stop that came first, or 0.
int stop_signal();

}  // namespace backlight
