// Where threads wake: each on a CPU of its own, at once.
#pragma once

#include <sched.h>

#include <cstddef>
#include <thread>
#include <vector>

namespace backlight {

/// Two threads that are woken together may be put on one CPU while another has nothing to do, and it takes
/// the system a hundredth of a second or more to see that: as long as a frame. So whoever wakes threads says
/// where each is to begin. Only that: a thread that has begun may be moved as ever.
class ThreadSpread {
 public:
  /// For threads that may run wherever the calling one may.
  ThreadSpread();

  /// How many CPUs those are; 0 where the system does not tell.
  [[nodiscard]] std::size_t cpus() const { return cpus_.size(); }

  /// The sleeping thread is to wake on the CPU that comes `index` + 1 after the caller's, in the round of
  /// those allowed, and to stay until it calls release(). False: the system refuses.
  bool place(std::thread::native_handle_type thread, std::size_t index) const;

  /// The calling thread may run wherever the one could that made this. False: the system refuses, and the
  /// thread stays where it was put.
  bool release() const;

 private:
  std::vector<cpu_set_t> mask_;  // as many as the kernel's own mask needs
  std::vector<std::size_t> cpus_;
};

}  // namespace backlight
