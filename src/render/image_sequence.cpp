#include "backlight/render/image_sequence.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <unordered_set>
#include <utility>

namespace backlight {
namespace {

constexpr std::int64_t most_frames = 1000000;
constexpr int widest_number = 20;

// Takes a whole number off the front of `text`.
std::optional<int> take_number(std::string_view& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

bool take(std::string_view& text, char c) {
  if (text.empty() || text.front() != c) return false;
  text.remove_prefix(1);
  return true;
}

struct FrameRange {
  int first = 0;
  int last = 0;
  int step = 1;
};

Failure not_a_range(std::string_view item) {
  return {"'" + std::string(item) +
          "' is not a range of frames: write 7, 1-100 or 1-100x2, with commas between several"};
}

Result<FrameRange> parse_range(std::string_view item) {
  std::string_view rest = item;
  FrameRange range;
  const auto first = take_number(rest);
  if (!first) return not_a_range(item);
  range.first = range.last = *first;
  if (take(rest, '-')) {
    const auto last = take_number(rest);
    if (!last) return not_a_range(item);
    range.last = *last;
    if (take(rest, 'x')) {
      const auto step = take_number(rest);
      if (!step) return not_a_range(item);
      if (*step < 1) return Failure{"the step of '" + std::string(item) + "' must be at least 1"};
      range.step = *step;
    }
  }
  if (!rest.empty()) return not_a_range(item);
  if (range.last < range.first) return Failure{"the range '" + std::string(item) + "' runs backwards"};
  return range;
}

std::string padded(int number, int width) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%0*d", width, number);
  return digits;
}

}  // namespace

Result<std::vector<int>> parse_frames(std::string_view text) {
  std::vector<int> frames;
  std::unordered_set<int> seen;
  while (true) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const auto range = parse_range(text.substr(0, comma));
    if (!range.ok()) return range.failure();
    const auto [first, last, step] = range.value();
    const std::int64_t count = (std::int64_t{last} - first) / step + 1;
    if (count + static_cast<std::int64_t>(frames.size()) > most_frames) {
      return Failure{"these are more than a million frames"};
    }
    for (std::int64_t frame = first; frame <= last; frame += step) {
      if (seen.insert(static_cast<int>(frame)).second) frames.push_back(static_cast<int>(frame));
    }
    if (comma == text.size()) return frames;
    text.remove_prefix(comma + 1);
  }
}

Result<OutputPattern> OutputPattern::parse(std::string_view text) {
  if (text.empty()) return Failure{"the name of the output file is empty"};
  OutputPattern pattern;
  const std::string whole(text);
  const std::size_t name = text.rfind('/') + 1;  // 0 where there is no slash
  std::string literal = whole.substr(0, name);
  text.remove_prefix(name);
  const auto add_number = [&](int width) {
    if (!literal.empty()) pattern.pieces_.push_back({std::exchange(literal, {}), -1});
    pattern.pieces_.push_back({{}, width});
    pattern.has_number_ = true;
  };
  while (!text.empty()) {
    if (text.front() == '#') {
      const std::size_t hashes = std::min(text.find_first_not_of('#'), text.size());
      text.remove_prefix(hashes);
      if (hashes > widest_number) return Failure{"'" + whole + "' has more than 20 hashes"};
      add_number(hashes == 1 ? 4 : static_cast<int>(hashes));
    } else if (take(text, '%')) {
      if (take(text, '%')) {
        literal += '%';
        continue;
      }
      const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
      const std::string_view width = text.substr(0, digits);
      int value = 0;
      std::from_chars(width.data(), width.data() + width.size(), value);
      text.remove_prefix(digits);
      const bool zero_filled = width.empty() || width.front() == '0';
      if (!take(text, 'd') || !zero_filled || width.size() > 3 || value > widest_number) {
        return Failure{"'" + whole + "': after % comes 04d (or another width), or % for a percent sign"};
      }
      add_number(value);
    } else {
      literal += text.front();
      text.remove_prefix(1);
    }
  }
  if (!literal.empty()) pattern.pieces_.push_back({std::move(literal), -1});
  return pattern;
}

OutputPattern OutputPattern::literal(std::string name) {
  OutputPattern pattern;
  pattern.pieces_ = {{std::move(name), -1}};
  return pattern;
}

OutputPattern OutputPattern::with_file(std::string_view name) const {
  OutputPattern pattern = *this;
  const bool ends_in_slash = pattern.pieces_.back().text.ends_with('/');
  if (!ends_in_slash) pattern.append("/");
  pattern.append(name);
  return pattern;
}

void OutputPattern::append(std::string_view text) {
  if (pieces_.empty() || pieces_.back().width >= 0) pieces_.emplace_back();
  pieces_.back().text += text;
}

OutputPattern OutputPattern::numbered() const {
  if (has_number_) return *this;
  OutputPattern pattern;
  std::filesystem::path path(pieces_.front().text);  // without a number there is one piece
  const std::string extension = path.extension().string();
  pattern.pieces_ = {{path.replace_extension().string() + ".", -1}, {{}, 4}, {extension, -1}};
  pattern.has_number_ = true;
  return pattern;
}

std::filesystem::path OutputPattern::path(int frame) const {
  std::string name;
  for (const Piece& piece : pieces_) name += piece.width < 0 ? piece.text : padded(frame, piece.width);
  return name;
}

}  // namespace backlight
