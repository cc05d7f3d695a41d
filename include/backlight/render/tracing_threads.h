// Threads that trace one image after the other, without waiting between them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "backlight/base/thread_spread.h"
#include "backlight/render/render.h"

namespace backlight {

/// How long threads had tiles to trace, and how long they had none.
struct TracingTime {
  double seconds = 0.0;  ///< from the begin of the first tile to the end of the last
  double traced = 0.0;   ///< in tiles: summed over the threads
  int threads = 1;

  /// The part of the threads' time between the first tile and the last in which they had no tile in hand.
  [[nodiscard]] double lost() const;
};

/// The threads take the tiles of the images in the order in which these are begun. A thread that finds no
/// tile left in an image goes on with the next, while others finish theirs: so images must be begun before
/// those in hand are done. For use by one thread.
class TracingThreads {
 public:
  using Clock = std::chrono::steady_clock;

  /// Where there are fewer threads to be had, those trace; where there are none, the caller's does in
  /// finish().
  TracingThreads(int threads, const std::atomic<bool>& stop);
  /// Nothing may be in hand.
  ~TracingThreads();
  TracingThreads(const TracingThreads&) = delete;
  TracingThreads& operator=(const TracingThreads&) = delete;

  /// How many threads trace, at least 1.
  [[nodiscard]] int count() const;

  /// Appends an image to those in hand. It must stay until finish() has returned for it.
  void begin(ImageTracing& image);
  /// Begins an image that finish() returned before its end again, ahead of all others in hand.
  void go_on_with(ImageTracing& image);

  /// Waits until the first of the images in hand will be done in a moment: time to begin another. Returns at
  /// once if none is, and soon after `stop` has turned true.
  void wait_for_tail();

  /// Whether finish() would return at once; false if nothing is in hand.
  [[nodiscard]] bool first_is_done() const;

  /// Waits until no thread is in the first of the images in hand and none will be, since all its tiles were
  /// taken, or `stop` is true, or one of them threw: that exception is rethrown. The image is then no longer
  /// in hand. Returns the time from its first tile to its last, in seconds.
  double finish();

  /// Of all images that are finished.
  [[nodiscard]] TracingTime time() const;

 private:
  struct Job;
  enum class State { waits, is_placed, works };
  void append(std::unique_ptr<Job> job, bool first);
  void work(int thread);
  Job* next_job();
  void work_on(Job& job, int thread, std::unique_lock<std::mutex>& lock);
  double take_tiles(Job& job, int thread);
  void look_at_tail(Job& job, Clock::time_point now);

  const std::atomic<bool>& stop_;
  const ThreadSpread spread_;
  mutable std::mutex guard_;  // of all that follows
  std::condition_variable has_work_;
  std::condition_variable has_news_;
  std::deque<std::unique_ptr<Job>> jobs_;
  bool closing_ = false;
  Clock::time_point first_begin_ = Clock::time_point::max();
  Clock::time_point last_end_ = Clock::time_point::min();
  double traced_ = 0.0;
  std::vector<State> states_;          // by thread
  std::vector<std::jthread> threads_;  // last: they use the others
};

}  // namespace backlight
