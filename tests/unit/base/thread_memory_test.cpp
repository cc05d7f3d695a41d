#include "backlight/base/thread_memory.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace backlight::test {
namespace {

int living = 0;  // of the threads of these tests one runs at a time

struct Counted {
  explicit Counted(int given) : value(given) { ++living; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  ~Counted() { --living; }
  int value;
};

Counted& first(int given) {
  static constinit thread_local ThreadMemory<Counted> memory;
  return memory.get(given);
}

Counted& second(int given) {
  static constinit thread_local ThreadMemory<Counted> memory;
  return memory.get(given);
}

TEST(ThreadMemory, IsMadeOnceInEachThreadAndEndsWithIt) {
  for (int thread = 0; thread < 3; ++thread) {
    std::thread([thread] {
      EXPECT_EQ(living, 0);
      EXPECT_EQ(first(thread).value, thread);
      EXPECT_EQ(second(7).value, 7);
      EXPECT_EQ(first(100).value, thread) << "it is there already";
      EXPECT_NE(&first(0), &second(0));
      EXPECT_EQ(living, 2);
    }).join();
    EXPECT_EQ(living, 0);
  }
}

TEST(ThreadMemory, OfAThreadThatNeverAsksIsNotMade) {
  std::thread([] {}).join();
  EXPECT_EQ(living, 0);
}

}  // namespace
}  // namespace backlight::test
