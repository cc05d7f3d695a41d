#include "backlight/render/tracing_threads.h"

#include <algorithm>
#include <utility>

namespace backlight {
namespace {

using Seconds = std::chrono::duration<double>;

// In this time the next image is made ready, if it is not a large scene of its own.
constexpr double tail = 0.03;  // seconds

// A signal sets `stop` and wakes nobody.
constexpr auto look_again = std::chrono::milliseconds(20);

}  // namespace

struct TracingThreads::Job {
  explicit Job(ImageTracing& the_image) : image(&the_image), tiles(the_image.tile_count()) {}

  ImageTracing* image;
  std::size_t tiles;
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> done{0};
  std::atomic<bool> failed{false};
  // With the lock:
  int threads_in_it = 0;
  bool all_taken = false;
  bool is_in_tail = false;
  std::exception_ptr failure;
  double traced = 0.0;
  Clock::time_point begin = Clock::time_point::max();
  Clock::time_point end = Clock::time_point::min();

  [[nodiscard]] bool is_finished() const { return all_taken && threads_in_it == 0; }
};

double TracingTime::lost() const {
  const double all = seconds * threads;
  return all > 0.0 ? std::max(0.0, 1.0 - traced / all) : 0.0;
}

TracingThreads::TracingThreads(int threads, const std::atomic<bool>& stop)
    : stop_(stop), states_(static_cast<std::size_t>(std::max(threads, 1)), State::waits) {
  for (int i = 0; i < std::max(threads, 1); ++i) {
    try {
      threads_.emplace_back([this, i] { work(i); });
    } catch (const std::exception&) {  // no thread, or no memory for one
      break;
    }
  }
}

TracingThreads::~TracingThreads() {
  const std::lock_guard lock(guard_);
  closing_ = true;
  has_work_.notify_all();
}

int TracingThreads::count() const {
  return std::max(1, static_cast<int>(threads_.size()));
}

void TracingThreads::begin(ImageTracing& image) {
  append(std::make_unique<Job>(image), false);
}

void TracingThreads::go_on_with(ImageTracing& image) {
  append(std::make_unique<Job>(image), true);
}

void TracingThreads::append(std::unique_ptr<Job> job, bool first) {
  const std::lock_guard lock(guard_);
  // Before the job is there: where memory fails, nobody would be told of it. More threads than CPUs share
  // some in any case.
  for (std::size_t i = 0; i < threads_.size() && threads_.size() > 1 && threads_.size() <= spread_.cpus();
       ++i) {
    if (states_[i] == State::waits && spread_.place(threads_[i].native_handle(), i)) {
      states_[i] = State::is_placed;
    }
  }
  jobs_.insert(first ? jobs_.begin() : jobs_.end(), std::move(job));
  has_work_.notify_all();
}

void TracingThreads::wait_for_tail() {
  if (threads_.empty()) return;
  std::unique_lock lock(guard_);
  const auto is_time = [this] {
    return jobs_.empty() || jobs_.front()->is_in_tail || jobs_.front()->is_finished() || stop_.load();
  };
  while (!is_time()) has_news_.wait_for(lock, look_again);
}

bool TracingThreads::first_is_done() const {
  const std::lock_guard lock(guard_);
  return !jobs_.empty() && jobs_.front()->is_finished();
}

double TracingThreads::finish() {
  std::unique_lock lock(guard_);
  if (threads_.empty()) work_on(*jobs_.front(), 0, lock);
  has_news_.wait(lock, [this] { return jobs_.front()->is_finished(); });
  const std::unique_ptr<Job> job = std::move(jobs_.front());
  jobs_.pop_front();
  if (job->begin < job->end) {
    first_begin_ = std::min(first_begin_, job->begin);
    last_end_ = std::max(last_end_, job->end);
    traced_ += job->traced;
  }
  if (job->failure) std::rethrow_exception(job->failure);
  return job->begin < job->end ? Seconds(job->end - job->begin).count() : 0.0;
}

TracingTime TracingThreads::time() const {
  const std::lock_guard lock(guard_);
  const double seconds = first_begin_ < last_end_ ? Seconds(last_end_ - first_begin_).count() : 0.0;
  return {seconds, traced_, count()};
}

// With the lock.
TracingThreads::Job* TracingThreads::next_job() {
  const auto job = std::find_if(jobs_.begin(), jobs_.end(), [](const auto& j) { return !j->all_taken; });
  return job != jobs_.end() ? job->get() : nullptr;
}

void TracingThreads::work(int thread) {
  std::unique_lock lock(guard_);
  while (true) {
    Job* job = nullptr;
    State& state = states_[static_cast<std::size_t>(thread)];
    if (next_job() == nullptr) state = State::waits;
    has_work_.wait(lock, [&] { return (job = next_job()) != nullptr || closing_; });
    if (job == nullptr) return;
    // If it is refused, the thread goes on working where it is.
    if (state == State::is_placed) static_cast<void>(spread_.release());
    state = State::works;
    work_on(*job, thread, lock);
  }
}

// With the lock, which it gives up while it traces.
void TracingThreads::work_on(Job& job, int thread, std::unique_lock<std::mutex>& lock) {
  ++job.threads_in_it;
  job.begin = std::min(job.begin, Clock::now());
  lock.unlock();
  const double traced = take_tiles(job, thread);
  lock.lock();
  job.traced += traced;
  --job.threads_in_it;
  job.all_taken = true;
  job.end = std::max(job.end, Clock::now());
  if (job.is_finished()) has_news_.notify_one();
}

// Until none is left to begin. Returns the seconds spent in tiles.
double TracingThreads::take_tiles(Job& job, int thread) {
  double traced = 0.0;
  while (!stop_.load(std::memory_order_relaxed) && !job.failed.load(std::memory_order_relaxed)) {
    const std::size_t i = job.next.fetch_add(1, std::memory_order_relaxed);
    if (i >= job.tiles) break;
    const Clock::time_point begin = Clock::now();
    try {
      job.image->tile(i, thread);
    } catch (...) {
      const std::lock_guard lock(guard_);
      if (!job.failure) job.failure = std::current_exception();
      job.failed.store(true, std::memory_order_relaxed);
    }
    const Clock::time_point end = Clock::now();
    traced += Seconds(end - begin).count();
    look_at_tail(job, end);
  }
  return traced;
}

void TracingThreads::look_at_tail(Job& job, Clock::time_point now) {
  const auto done = double(job.done.fetch_add(1, std::memory_order_relaxed) + 1);
  const std::lock_guard lock(guard_);
  if (job.is_in_tail) return;
  const double taken = Seconds(now - job.begin).count();
  job.is_in_tail = taken * (double(job.tiles) - done) < tail * done;
  if (job.is_in_tail && jobs_.front().get() == &job) has_news_.notify_one();
}

}  // namespace backlight
