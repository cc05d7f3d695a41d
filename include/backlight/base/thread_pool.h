// Independent pieces of work on several threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace backlight {

/// Calls task(i, thread) once for each i of 0 ... count - 1, on up to `threads` threads (fewer where no more
/// can be begun), of which the caller is one; `thread` (0 ... threads - 1) tells which, for scratch memory.
/// The pieces are taken in order of i, but which thread takes which is left to chance: results must not
/// depend on it.
///
/// When `stop` turns true no further piece is begun; those in hand are finished, or may look at `stop`
/// themselves and return early. When a piece throws, the others in hand are finished and the first exception
/// is rethrown to the caller. Returns whether all pieces were done and `stop` is still false.
bool run_on_threads(std::size_t count, int threads, const std::atomic<bool>& stop,
                    const std::function<void(std::size_t, int)>& task);

/// How many threads this process should use: the CPUs that it may run on (its affinity mask, which
/// batch systems and containers narrow), and no more than SLURM_CPUS_PER_TASK where that is set. At least 1.
int usable_threads();

/// From now on the calling thread, and those that it begins, do not push others off their CPU when they are
/// woken: they wait for one that is free, or for their turn. For those that serve threads which compute.
/// Where the system does not allow it, nothing changes.
void serve_in_background();

}  // namespace backlight
