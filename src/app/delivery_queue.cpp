#include "delivery_queue.h"

#include <chrono>
#include <exception>
#include <memory>
#include <system_error>
#include <utility>

namespace backlight {
namespace {

// So many small images hide a disk that takes ten times as long as tracing; of large ones two or three do.
constexpr std::size_t most_images = 24;
constexpr std::size_t most_bytes = std::size_t{256} << 20U;

template <typename Work>
Result<void> result_of(const Work& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    return Failure{error.what()};
  }
}

template <typename Work>
std::future<void> begin(const Work& work) {
  try {
    return std::async(std::launch::async, work);
  } catch (const std::system_error&) {  // no more threads are to be had
    work();
    std::promise<void> done;
    done.set_value();
    return done.get_future();
  }
}

}  // namespace

bool DeliveryQueue::has_room_for(std::size_t bytes) const {
  return on_their_way_.empty() || (on_their_way_.size() < most_images && bytes_ + bytes <= most_bytes);
}

void DeliveryQueue::settle_first() {
  on_their_way_.front().done.get();
  bytes_ -= on_their_way_.front().bytes;
  on_their_way_.pop_front();
}

void DeliveryQueue::add(std::size_t bytes, Store store, Tell tell) {
  const auto is_done = [](const OnItsWay& item) {
    return item.done.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  };
  while (!has_room_for(bytes) || (!on_their_way_.empty() && is_done(on_their_way_.front()))) settle_first();

  // The turn of the next is a promise of its own: to wait for the thread would keep its image.
  const auto has_told = std::make_shared<std::promise<void>>();
  const std::shared_future<void> turn = std::exchange(all_have_told_, has_told->get_future().share());
  const auto work = [this, turn, has_told, store = std::move(store), tell = std::move(tell)] {
    const Result<void> stored = result_of(store);
    if (turn.valid()) turn.wait();
    if (!result_of([&] { return tell(stored); }).ok()) failed_.store(true);
    has_told->set_value();
  };
  on_their_way_.push_back({bytes, begin(work)});
  bytes_ += bytes;
}

void DeliveryQueue::wait() {
  while (!on_their_way_.empty()) settle_first();
}

}  // namespace backlight
