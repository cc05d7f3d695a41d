// Finished images on their way into their files, while the next ones are traced.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "backlight/base/result.h"

namespace backlight {

/// To be sure that a small image is on the disk may take longer than to trace it. Here images are stored by
/// threads of their own, several at a time; what is told of them comes in their order. At any moment a
/// bounded number of images is on its way. For use by one thread.
class DeliveryQueue {
 public:
  using Store = std::function<Result<void>()>;
  using Tell = std::function<Result<void>(const Result<void>& stored)>;

  DeliveryQueue() = default;
  /// Waits for what is on its way.
  ~DeliveryQueue();
  DeliveryQueue(const DeliveryQueue&) = delete;
  DeliveryQueue& operator=(const DeliveryQueue&) = delete;

  /// `store` runs beside those of other images. `tell` follows when all images before have told; what it
  /// returns is the end of the matter. Waits while too many are on their way.
  void add(Store store, Tell tell);

  /// Waits until nothing is on its way.
  void wait();

  /// Whether anything has come to a bad end so far.
  [[nodiscard]] bool has_failed() const { return failed_.load(); }

 private:
  struct Item {
    Store store;
    Tell tell;
    bool is_taken = false;
    std::optional<Result<void>> stored;
  };
  using Lock = std::unique_lock<std::mutex>;

  void work();
  bool store_one(Lock& lock);
  void tell_in_order(Lock& lock);
  void start_thread();

  std::atomic<bool> failed_{false};
  std::mutex guard_;  // of all that follows
  std::condition_variable has_work_;
  std::condition_variable has_room_;
  std::deque<std::unique_ptr<Item>> on_their_way_;
  std::size_t not_taken_ = 0;
  std::size_t idle_ = 0;
  bool is_telling_ = false;
  bool closing_ = false;
  std::vector<std::jthread> threads_;  // last: they use the others
};

}  // namespace backlight
