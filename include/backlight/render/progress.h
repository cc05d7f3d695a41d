// How far a run is, counted by the tile threads and told on a stream (stderr) while they work.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <iosfwd>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace backlight {

/// `automatic` is `bar` on a terminal and `lines` elsewhere.
enum class ProgressStyle { automatic, bar, lines, json, none };

/// A moment of a run over one or more images.
struct ProgressState {
  std::string file;  ///< of the first image in hand
  int images = 1;    ///< in the whole run
  int images_done = 0;
  double image_part = 0.0;  ///< 0 ... 1: how much of the image in hand is done; up to 2, of two in hand
  double elapsed = 0.0;     ///< seconds since the run began

  [[nodiscard]] double fraction() const;  ///< of the whole run, 0 ... 1
  /// Seconds still to go if the rest is as quick as what is done; negative while too little is done to tell.
  [[nodiscard]] double remaining() const;
};

/// "  45% [=========>          ] image 3/10 shot.0003.exr  0:12, 0:15 left", cut to `columns`.
std::string progress_bar(const ProgressState& state, int columns, bool colour);
/// "Progress: 45% (image 3 of 10, shot.0003.exr, 0:12 elapsed, about 0:15 left)".
std::string progress_line(const ProgressState& state);
/// {"event":"progress","fraction":0.45,"image":3,"images":10,"file":"shot.0003.exr","elapsed":12.1,"remaining":14.8}
std::string progress_json(const ProgressState& state);

/// Tells how a run goes, from a thread of its own. `advance` and `say` may be called from any thread,
/// and the former takes no lock; the others belong to the thread that drives the run.
class ProgressReporter {
 public:
  struct Settings {
    ProgressStyle style = ProgressStyle::automatic;
    int images = 1;
    std::chrono::milliseconds interval{0};  ///< 0: 100 ms for a bar, 10 s for lines, 1 s for json
  };

  /// `out` must outlive the reporter. Whether it is a terminal, its width, and NO_COLOR are those of stderr.
  ProgressReporter(std::ostream& out, Settings settings);
  /// Ends the reporting and takes the bar away.
  ~ProgressReporter();
  ProgressReporter(const ProgressReporter&) = delete;
  ProgressReporter& operator=(const ProgressReporter&) = delete;

  /// One more image in hand, of `units` pieces of equal work (tiles, or pixels).
  void begin_image(std::string_view file, std::uint64_t units);
  /// What was traced of the images in hand is gone through again.
  void restart_images() { units_done_.store(0, std::memory_order_relaxed); }
  /// From any thread: some of them are done.
  void advance(std::uint64_t units = 1) { units_done_.fetch_add(units, std::memory_order_relaxed); }
  /// The first of the images in hand is done. Lines and json report the end of the run at once.
  void end_image();

  /// The first of the images in hand will not be done: it failed, or was put aside.
  void drop_image();

  /// One image less to make than was thought: the time that is left is guessed from those that are made.
  void skip_image();

  /// A line for the reader, kept clear of the bar.
  void say(std::string_view line);

  [[nodiscard]] ProgressStyle style() const { return style_; }

 private:
  void report_until_stopped(std::stop_token stop);
  void report();  // with the lock held
  void clear_bar();
  void forget_first();
  [[nodiscard]] ProgressState state() const;

  std::ostream& out_;
  ProgressStyle style_;
  bool colour_ = false;
  bool bar_is_shown_ = false;
  std::chrono::milliseconds interval_;
  std::chrono::steady_clock::time_point start_;

  mutable std::mutex guard_;  // of the stream, and of the four below
  struct ImageInHand {
    std::string file;
    std::uint64_t units;
  };
  std::deque<ImageInHand> in_hand_;
  std::string last_file_;
  int images_;
  int images_done_ = 0;

  std::atomic<std::uint64_t> units_done_{0};
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it uses all the others
};

}  // namespace backlight
