#include "backlight/base/thread_pool.h"

#include <gtest/gtest.h>

#include <sched.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace backlight {
namespace {

const std::atomic<bool> never{false};

TEST(RunOnThreads, DoesEachPieceOnce) {
  for (const int threads : {-1, 0, 1, 2, 7, 64}) {
    std::vector<std::atomic<int>> calls(1000);
    EXPECT_TRUE(run_on_threads(calls.size(), threads, never, [&](std::size_t i, int) { ++calls[i]; }));
    for (const auto& count : calls) ASSERT_EQ(count.load(), 1) << threads;
  }
}

TEST(RunOnThreads, DoesNothingWithoutPieces) {
  EXPECT_TRUE(run_on_threads(0, 4, never, [](std::size_t, int) { ADD_FAILURE(); }));
}

TEST(RunOnThreads, NumbersItsThreads) {
  std::vector<std::atomic<int>> busy(3);
  EXPECT_TRUE(run_on_threads(300, 3, never, [&](std::size_t, int thread) {
    ASSERT_GE(thread, 0);
    ASSERT_LT(thread, 3);
    EXPECT_EQ(busy[static_cast<std::size_t>(thread)].fetch_add(1), 0) << "two threads of one number";
    std::this_thread::yield();
    --busy[static_cast<std::size_t>(thread)];
  }));
}

TEST(RunOnThreads, StopsWhenTold) {
  std::atomic<bool> stop{false};
  std::atomic<int> calls{0};
  EXPECT_FALSE(run_on_threads(100000, 4, stop, [&](std::size_t, int) {
    if (++calls == 10) stop = true;
  }));
  EXPECT_LT(calls.load(), 100);
  EXPECT_FALSE(run_on_threads(1, 4, stop, [](std::size_t, int) { ADD_FAILURE(); }));
}

TEST(RunOnThreads, PassesOnAnException) {
  std::atomic<int> calls{0};
  const auto task = [&](std::size_t i, int) {
    ++calls;
    if (i == 5) throw std::runtime_error("piece 5");
    if (i > 5)
      std::this_thread::sleep_for(std::chrono::microseconds(20));  // else all is done before it is thrown
  };
  EXPECT_THROW(run_on_threads(100000, 4, never, task), std::runtime_error);
  EXPECT_LT(calls.load(), 100000);
}

TEST(UsableThreads, IsWithinTheAffinityMask) {
  unsetenv("SLURM_CPUS_PER_TASK");
  cpu_set_t set;
  ASSERT_EQ(sched_getaffinity(0, sizeof set, &set), 0);
  EXPECT_EQ(usable_threads(), CPU_COUNT(&set));
  setenv("SLURM_CPUS_PER_TASK", "1", 1);
  EXPECT_EQ(usable_threads(), 1);
  for (const char* text : {"1000000", "none", "-3", "0", "", "1x"}) {
    setenv("SLURM_CPUS_PER_TASK", text, 1);
    EXPECT_EQ(usable_threads(), CPU_COUNT(&set)) << text;
  }
  unsetenv("SLURM_CPUS_PER_TASK");
}

TEST(UsableThreads, FollowsANarrowedMask) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  std::thread([&before] {
    cpu_set_t one;
    CPU_ZERO(&one);
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
      if (!CPU_ISSET(cpu, &before)) continue;
      CPU_SET(cpu, &one);
      break;
    }
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    EXPECT_EQ(usable_threads(), 1);
  }).join();
}

}  // namespace
}  // namespace backlight
