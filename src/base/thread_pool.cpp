#include "backlight/base/thread_pool.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace backlight {
namespace {

// The mask is asked for with room for ever more CPUs, since the kernel refuses one that is too small.
int affinity_count() {
  for (int cpus = CPU_SETSIZE; cpus <= (1 << 20); cpus *= 2) {
    cpu_set_t* set = CPU_ALLOC(static_cast<std::size_t>(cpus));
    if (set == nullptr) break;
    const std::size_t size = CPU_ALLOC_SIZE(static_cast<std::size_t>(cpus));
    const bool known = sched_getaffinity(0, size, set) == 0;
    const int count = known ? CPU_COUNT_S(size, set) : 0;
    CPU_FREE(set);
    if (known) return count;
  }
  return static_cast<int>(std::thread::hardware_concurrency());
}

}  // namespace

bool run_on_threads(std::size_t count, int threads, const std::atomic<bool>& stop,
                    const std::function<void(std::size_t, int)>& task) {
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> done{0};
  std::atomic<bool> failed{false};
  std::mutex failure_guard;
  std::exception_ptr failure;

  const auto work = [&](int thread) {
    try {
      while (!stop.load(std::memory_order_relaxed) && !failed.load(std::memory_order_relaxed)) {
        const std::size_t i = next.fetch_add(1, std::memory_order_relaxed);
        if (i >= count) return;
        task(i, thread);
        done.fetch_add(1, std::memory_order_relaxed);
      }
    } catch (...) {
      const std::lock_guard lock(failure_guard);
      if (!failure) failure = std::current_exception();
      failed.store(true, std::memory_order_relaxed);
    }
  };

  {
    const auto helpers = static_cast<std::size_t>(std::max(threads, 1)) - 1;
    std::vector<std::jthread> pool;
    try {
      for (std::size_t i = 0; i < helpers && i + 1 < count; ++i)
        pool.emplace_back(work, static_cast<int>(i) + 1);
    } catch (const std::system_error&) {  // those there are do it all
    }
    work(0);
  }
  if (failure) std::rethrow_exception(failure);
  return done.load() == count && !stop.load();
}

void serve_in_background() {
  const sched_param parameters{};
  pthread_setschedparam(pthread_self(), SCHED_BATCH, &parameters);
}

int usable_threads() {
  int count = affinity_count();
  if (const char* text = std::getenv("SLURM_CPUS_PER_TASK")) {
    int granted = 0;
    const auto [end, error] = std::from_chars(text, text + std::strlen(text), granted);
    if (error == std::errc() && *end == '\0' && granted > 0) count = std::min(count, granted);
  }
  return std::max(count, 1);
}

}  // namespace backlight
