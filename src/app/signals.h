// Being asked to stop: Ctrl-C, a batch system's SIGTERM, a closed terminal.
//
// These signals are held back from the first instructions of the program, before anything is set up that
// could be interrupted: what comes while it is being loaded is answered like what comes later.
#pragma once

#include <atomic>

namespace backlight {

/// From now on SIGINT, SIGTERM and SIGHUP turn stop_requested() true; a second one ends the process at once,
/// with exit code 128 + its number. SIGUSR1 asks for a snapshot. A signal that was ignored (nohup) stays
/// ignored.
void catch_stop_signals();

/// The signals that were held back come now, and all others when they are sent.
void release_held_signals();

/// From now on a file beyond a size limit, and a pipe that nobody reads any more, are ordinary write errors
/// instead of SIGXFSZ and SIGPIPE.
void make_signals_of_writing_errors();

/// Ends the program as SIGPIPE does, unless that was ignored when it began.
void end_by_broken_pipe();

/// Turns true at the first signal, and stays so.
const std::atomic<bool>& stop_requested();

/// Turns true when tracing is to pause: at the first signal to stop, and for a snapshot.
const std::atomic<bool>& pause_requested();

/// Whether a snapshot was asked for since the last call.
bool take_snapshot_request();

/// The signal to stop that came first, or 0.
int stop_signal();

}  // namespace backlight
