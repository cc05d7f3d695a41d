#include "backlight/base/thread_spread.h"

#include <pthread.h>

#include <algorithm>

namespace backlight {

ThreadSpread::ThreadSpread() {
  // The mask is asked for with room for ever more CPUs, since the kernel refuses one that is too small.
  for (std::size_t sets = 1; sets <= 1024; sets *= 2) {
    mask_.assign(sets, cpu_set_t{});
    const std::size_t size = sets * sizeof(cpu_set_t);
    if (sched_getaffinity(0, size, mask_.data()) != 0) continue;
    for (std::size_t cpu = 0; cpu < sets * CPU_SETSIZE; ++cpu) {
      if (CPU_ISSET_S(cpu, size, mask_.data())) cpus_.push_back(cpu);
    }
    return;
  }
}

bool ThreadSpread::place(std::thread::native_handle_type thread, std::size_t index) const {
  const int here = sched_getcpu();
  if (cpus_.empty() || here < 0) return false;
  const auto own = std::find(cpus_.begin(), cpus_.end(), static_cast<std::size_t>(here));
  const auto begin = static_cast<std::size_t>(own - cpus_.begin());  // past the end if it may not be here now
  std::vector<cpu_set_t> one(mask_.size(), cpu_set_t{});
  const std::size_t size = one.size() * sizeof(cpu_set_t);
  CPU_SET_S(cpus_[(begin + index + 1) % cpus_.size()], size, one.data());
  return pthread_setaffinity_np(thread, size, one.data()) == 0;
}

bool ThreadSpread::release() const {
  return pthread_setaffinity_np(pthread_self(), mask_.size() * sizeof(cpu_set_t), mask_.data()) == 0;
}

}  // namespace backlight
