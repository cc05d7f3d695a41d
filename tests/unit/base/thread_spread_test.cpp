#include "backlight/base/thread_spread.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <condition_variable>
#include <mutex>
#include <set>

namespace backlight {
namespace {

std::set<int> usable_cpus() {
  cpu_set_t set;
  std::set<int> cpus;
  if (pthread_getaffinity_np(pthread_self(), sizeof set, &set) != 0) return cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(cpu, &set)) cpus.insert(cpu);
  }
  return cpus;
}

struct Woken {
  std::set<int> placed;
  std::set<int> released;
  bool was_released = false;
};

// Of a thread that sleeps until it has been placed.
Woken wake_placed(const ThreadSpread& spread, std::size_t index) {
  std::mutex guard;
  std::condition_variable wakes;
  bool go = false;
  Woken woken;
  std::jthread thread([&] {
    std::unique_lock lock(guard);
    wakes.wait(lock, [&] { return go; });
    woken.placed = usable_cpus();
    woken.was_released = spread.release();
    woken.released = usable_cpus();
  });
  EXPECT_TRUE(spread.place(thread.native_handle(), index));
  {
    const std::lock_guard lock(guard);
    go = true;
  }
  wakes.notify_one();
  thread.join();
  return woken;
}

TEST(ThreadSpread, PutsAThreadOnOneCpuUntilItIsReleased) {
  const std::set<int> all = usable_cpus();
  const ThreadSpread spread;
  ASSERT_EQ(spread.cpus(), all.size());
  for (std::size_t index = 0; index < 3; ++index) {
    const Woken woken = wake_placed(spread, index);
    EXPECT_EQ(woken.placed.size(), 1u);
    EXPECT_TRUE(all.contains(*woken.placed.begin()));
    EXPECT_TRUE(woken.was_released);
    EXPECT_EQ(woken.released, all);
  }
}

// As many threads as CPUs: each has its own. The caller stays where it is meanwhile.
TEST(ThreadSpread, GivesEachThreadItsOwnCpu) {
  const std::set<int> all = usable_cpus();
  std::set<int> used;
  std::jthread caller([&] {
    const ThreadSpread spread;
    cpu_set_t here;
    CPU_ZERO(&here);
    CPU_SET(*all.rbegin(), &here);
    ASSERT_EQ(pthread_setaffinity_np(pthread_self(), sizeof here, &here), 0);
    for (std::size_t i = 0; i < all.size(); ++i) used.merge(wake_placed(spread, i).placed);
  });
  caller.join();
  EXPECT_EQ(used, all);
}

}  // namespace
}  // namespace backlight
