#include "backlight/render/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ostream>
#include <system_error>
#include <utility>

#include "backlight/base/json_text.h"

namespace backlight {
namespace {

int percent(const ProgressState& state) {
  return static_cast<int>(std::floor(state.fraction() * 100.0));
}

// "0:07", "12:30", "1:02:03"
std::string clock_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(std::max(seconds, 0.0)));
  char text[32];
  if (whole >= 3600) {
    std::snprintf(text, sizeof text, "%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%lld:%02lld", whole / 60, whole % 60);
  }
  return text;
}

int current_image(const ProgressState& state) {
  return std::min(state.images_done + 1, state.images);
}

ProgressStyle resolved(ProgressStyle style) {
  if (style != ProgressStyle::automatic) return style;
  const char* terminal = std::getenv("TERM");
  const bool dumb = terminal != nullptr && std::string_view(terminal) == "dumb";
  return isatty(STDERR_FILENO) != 0 && !dumb ? ProgressStyle::bar : ProgressStyle::lines;
}

std::chrono::milliseconds usual_interval(ProgressStyle style) {
  if (style == ProgressStyle::bar) return std::chrono::milliseconds(100);
  return style == ProgressStyle::json ? std::chrono::seconds(1) : std::chrono::seconds(10);
}

int terminal_columns() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

// NO_COLOR set to anything but nothing turns colour off (no-color.org).
bool colour_wanted() {
  const char* no_colour = std::getenv("NO_COLOR");
  return isatty(STDERR_FILENO) != 0 && (no_colour == nullptr || *no_colour == '\0');
}

}  // namespace

double ProgressState::fraction() const {
  if (images <= 0) return 1.0;
  return std::clamp((images_done + std::clamp(image_part, 0.0, 2.0)) / images, 0.0, 1.0);
}

double ProgressState::remaining() const {
  const double done = fraction();
  if (done >= 1.0) return 0.0;
  if (done < 0.001 || elapsed < 0.2) return -1.0;
  return elapsed * (1.0 - done) / done;
}

std::string progress_bar(const ProgressState& state, int columns, bool colour) {
  constexpr int cells = 24;
  const int filled = static_cast<int>(state.fraction() * cells);
  std::string bar(static_cast<std::size_t>(filled), '=');
  if (filled < cells) bar += '>' + std::string(static_cast<std::size_t>(cells - filled - 1), ' ');

  char head[16];
  std::snprintf(head, sizeof head, "%4d%% ", percent(state));
  std::string tail = " " + clock_text(state.elapsed);
  if (state.remaining() >= 0.0) tail += ", " + clock_text(state.remaining()) + " left";
  if (state.images > 1)
    tail += "  image " + std::to_string(current_image(state)) + "/" + std::to_string(state.images);
  if (!state.file.empty()) tail += "  " + state.file;

  // Everything but the name is ASCII; a name that is cut in the middle of a character shows as one odd sign.
  const std::string plain = std::string(head) + "[" + bar + "]" + tail;
  const auto room = static_cast<std::size_t>(std::max(columns - 1, 0));
  if (!colour || plain.size() > room) return plain.substr(0, room);
  return std::string(head) + "[\x1b[36m" + bar + "\x1b[0m]" + tail;
}

std::string progress_line(const ProgressState& state) {
  std::string line = "Progress: " + std::to_string(percent(state)) + "% (";
  if (state.images > 1) {
    line += "image " + std::to_string(current_image(state)) + " of " + std::to_string(state.images) + ", ";
  }
  if (!state.file.empty()) line += state.file + ", ";
  line += clock_text(state.elapsed) + " elapsed";
  if (state.remaining() > 0.0) line += ", about " + clock_text(state.remaining()) + " left";
  return line + ")";
}

std::string progress_json(const ProgressState& state) {
  const auto rounded = [](double value, double step) { return json_number(std::round(value * step) / step); };
  std::string line = R"({"event":"progress","fraction":)" + rounded(state.fraction(), 1e4);
  line +=
      R"(,"image":)" + std::to_string(current_image(state)) + R"(,"images":)" + std::to_string(state.images);
  line += R"(,"file":)" + json_quoted(state.file) + R"(,"elapsed":)" + rounded(state.elapsed, 1e2);
  line += R"(,"remaining":)" + (state.remaining() < 0.0 ? "null" : rounded(state.remaining(), 1e2));
  return line + "}";
}

ProgressReporter::ProgressReporter(std::ostream& out, Settings settings)
    : out_(out),
      style_(resolved(settings.style)),
      colour_(colour_wanted()),
      interval_(settings.interval.count() > 0 ? settings.interval : usual_interval(style_)),
      start_(std::chrono::steady_clock::now()),
      images_(settings.images) {
  if (style_ == ProgressStyle::none) return;
  try {
    thread_ = std::jthread([this](std::stop_token stop) { report_until_stopped(std::move(stop)); });
  } catch (const std::system_error&) {  // what is said is said all the same
  }
}

ProgressReporter::~ProgressReporter() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  clear_bar();
  out_.flush();
}

void ProgressReporter::begin_image(std::string_view file, std::uint64_t units) {
  const std::lock_guard lock(guard_);
  if (in_hand_.empty()) units_done_.store(0, std::memory_order_relaxed);
  in_hand_.push_back({std::string(file), units});
}

void ProgressReporter::end_image() {
  const std::lock_guard lock(guard_);
  ++images_done_;
  forget_first();
  const bool tells_the_end = style_ == ProgressStyle::lines || style_ == ProgressStyle::json;
  if (tells_the_end && images_done_ == images_) report();
}

void ProgressReporter::drop_image() {
  const std::lock_guard lock(guard_);
  forget_first();
}

// With the lock held. Tiles of the next image may be done already.
void ProgressReporter::forget_first() {
  if (in_hand_.empty()) return;
  const std::uint64_t units = std::min(in_hand_.front().units, units_done_.load(std::memory_order_relaxed));
  units_done_.fetch_sub(units, std::memory_order_relaxed);
  last_file_ = std::move(in_hand_.front().file);
  in_hand_.pop_front();
}

void ProgressReporter::skip_image() {
  const std::lock_guard lock(guard_);
  --images_;
}

void ProgressReporter::say(std::string_view line) {
  const std::lock_guard lock(guard_);
  clear_bar();
  out_ << line << '\n' << std::flush;
}

ProgressState ProgressReporter::state() const {
  std::uint64_t units = 0;
  for (const ImageInHand& image : in_hand_) units += image.units;
  const auto done = static_cast<double>(units_done_.load(std::memory_order_relaxed));
  const double part = units > 0 ? std::min(done / static_cast<double>(units), 1.0) : 0.0;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  return {in_hand_.empty() ? last_file_ : in_hand_.front().file, images_, images_done_,
          part * static_cast<double>(in_hand_.size()), elapsed.count()};
}

void ProgressReporter::report_until_stopped(std::stop_token stop) {
  std::unique_lock lock(guard_);
  while (!wake_.wait_for(lock, stop, interval_, [&stop] { return stop.stop_requested(); })) {
    if (stop.stop_requested()) return;
    if (images_done_ < images_) report();
  }
}

void ProgressReporter::report() {
  switch (style_) {
    case ProgressStyle::bar:
      out_ << '\r' << progress_bar(state(), terminal_columns(), colour_) << "\x1b[K" << std::flush;
      bar_is_shown_ = true;
      break;
    case ProgressStyle::json:
      out_ << progress_json(state()) << '\n' << std::flush;
      break;
    case ProgressStyle::lines:
      out_ << progress_line(state()) << '\n' << std::flush;
      break;
    case ProgressStyle::automatic:
    case ProgressStyle::none:
      break;
  }
}

void ProgressReporter::clear_bar() {
  if (bar_is_shown_) out_ << "\r\x1b[K";
  bar_is_shown_ = false;
}

}  // namespace backlight
