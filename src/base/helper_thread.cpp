#include "backlight/base/helper_thread.h"

#include <exception>
#include <new>
#include <utility>

namespace backlight {
namespace {

// While it is at one task another waits, so that it never does.
constexpr std::size_t most_waiting = 2;

}  // namespace

HelperThread::HelperThread() {
  try {
    thread_ = std::jthread([this] { work(); });
  } catch (const std::exception&) {  // no thread, or no memory for one
  }
}

HelperThread::~HelperThread() {
  const std::lock_guard lock(guard_);
  closing_ = true;
  has_work_.notify_one();
}

bool HelperThread::takes(std::function<void()> task) {
  const std::lock_guard lock(guard_);
  if (!thread_.joinable() || tasks_.size() >= most_waiting) return false;
  try {
    tasks_.push_back(std::move(task));
  } catch (const std::bad_alloc&) {
    return false;
  }
  has_work_.notify_one();
  return true;
}

void HelperThread::work() {
  std::unique_lock lock(guard_);
  while (true) {
    has_work_.wait(lock, [this] { return !tasks_.empty() || closing_; });
    if (tasks_.empty()) return;
    const std::function<void()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    lock.lock();
  }
}

}  // namespace backlight
