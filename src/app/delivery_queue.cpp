#include "delivery_queue.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace backlight {
namespace {

// So many small images hide a disk that takes ten times as long as tracing.
constexpr std::size_t most_images = 24;

template <typename Work>
Result<void> result_of(const Work& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    return Failure{error.what()};
  }
}

}  // namespace

DeliveryQueue::~DeliveryQueue() {
  wait();
  const std::lock_guard lock(guard_);
  closing_ = true;
  has_work_.notify_all();
}

void DeliveryQueue::add(Store store, Tell tell) {
  Lock lock(guard_);
  has_room_.wait(lock, [this] { return on_their_way_.size() < most_images; });
  auto item = std::make_unique<Item>();
  item->store = std::move(store);
  item->tell = std::move(tell);
  on_their_way_.push_back(std::move(item));
  ++not_taken_;
  if (idle_ < not_taken_) start_thread();
  if (!threads_.empty()) {
    has_work_.notify_one();
    return;
  }
  while (store_one(lock)) {
  }
}

// With the lock. Without one more the others take longer; without any, the caller's does the work.
void DeliveryQueue::start_thread() {
  if (threads_.size() >= most_images) return;
  try {
    threads_.emplace_back([this] { work(); });
  } catch (const std::exception&) {
    return;
  }
}

void DeliveryQueue::wait() {
  Lock lock(guard_);
  has_room_.wait(lock, [this] { return on_their_way_.empty(); });
}

void DeliveryQueue::work() {
  Lock lock(guard_);
  while (true) {
    ++idle_;
    has_work_.wait(lock, [this] { return not_taken_ > 0 || closing_; });
    --idle_;
    if (!store_one(lock)) return;
  }
}

// With the lock, which it gives up while it stores and tells. False if nothing was left to store.
bool DeliveryQueue::store_one(Lock& lock) {
  const auto next = std::find_if(on_their_way_.begin(), on_their_way_.end(),
                                 [](const auto& item) { return !item->is_taken; });
  if (next == on_their_way_.end()) return false;
  Item& item = **next;
  item.is_taken = true;
  --not_taken_;
  lock.unlock();
  Result<void> stored = result_of(item.store);
  lock.lock();
  item.stored = std::move(stored);
  tell_in_order(lock);
  return true;
}

// Whoever stores the image that the others wait for tells of them too.
void DeliveryQueue::tell_in_order(Lock& lock) {
  if (is_telling_) return;
  is_telling_ = true;
  while (!on_their_way_.empty() && on_their_way_.front()->stored) {
    Item& item = *on_their_way_.front();
    lock.unlock();
    if (!result_of([&] { return item.tell(*item.stored); }).ok()) failed_.store(true);
    lock.lock();
    on_their_way_.pop_front();
    has_room_.notify_all();
  }
  is_telling_ = false;
}

}  // namespace backlight
