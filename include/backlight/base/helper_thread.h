// A thread that takes work off the hands of others.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace backlight {

/// Does what it is given in order, as long as it keeps up: who has more to give does it alone.
class HelperThread {
 public:
  /// Where no thread can be begun, nothing is ever taken.
  HelperThread();
  /// Finishes what was taken.
  ~HelperThread();
  HelperThread(const HelperThread&) = delete;
  HelperThread& operator=(const HelperThread&) = delete;

  /// Whether it takes the task, which must not throw. From any thread.
  bool takes(std::function<void()> task);

 private:
  void work();

  std::mutex guard_;  // of what follows
  std::condition_variable has_work_;
  std::deque<std::function<void()>> tasks_;
  bool closing_ = false;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace backlight
