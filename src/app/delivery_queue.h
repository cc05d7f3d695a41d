// Finished images on their way into their files, while the next ones are traced.
#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <functional>
#include <future>

#include "backlight/base/result.h"

namespace backlight {

/// To be sure that a small image is on the disk may take longer than to trace it. Here each image is stored
/// on a thread of its own, several at a time; what is told of them comes in their order. At any moment a
/// bounded number of images, and of bytes, is on its way. For use by one thread.
class DeliveryQueue {
 public:
  using Store = std::function<Result<void>()>;
  using Tell = std::function<Result<void>(const Result<void>& stored)>;

  /// `store` runs beside those of other images. `tell` follows when all images before have told; what it
  /// returns is the end of the matter. Waits while too much is on its way; `bytes` are held until then.
  void add(std::size_t bytes, Store store, Tell tell);

  /// Waits until nothing is on its way.
  void wait();

  /// Whether anything has come to a bad end so far.
  [[nodiscard]] bool has_failed() const { return failed_.load(); }

 private:
  struct OnItsWay {
    std::size_t bytes;
    std::future<void> done;
  };
  void settle_first();
  [[nodiscard]] bool has_room_for(std::size_t bytes) const;

  std::atomic<bool> failed_{false};
  std::size_t bytes_ = 0;
  std::shared_future<void> all_have_told_;  // of the images so far
  std::deque<OnItsWay> on_their_way_;       // last: its threads use the others
};

}  // namespace backlight
