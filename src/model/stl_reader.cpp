// STL, ascii and binary.
#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "read_model.h"

namespace backlight::models {
namespace {

constexpr std::size_t header_size = 84, facet_size = 50;

/// Corners in the same place are one.
class Corners {
 public:
  explicit Corners(Read& read) : read_(read) {}

  std::uint32_t add(const Triple& given) {
    Triple place = given;
    for (double& x : place) x += 0.0;  // of zeros only the positive one
    if (2 * read_.places.size() >= slots_.size()) grow();
    std::size_t slot = hash(place);
    for (;; ++slot) {
      std::uint32_t& number = slots_[slot & (slots_.size() - 1)];
      if (number == empty) return number = read_.add_corner(place);
      if (read_.places[number] == place) return number;
    }
  }

 private:
  static constexpr std::uint32_t empty = ~std::uint32_t{0};

  static std::size_t hash(const Triple& place) {
    std::uint64_t sum = 0;
    for (const double x : place) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &x, sizeof bits);
      sum = (sum ^ bits) * 0x9e3779b97f4a7c15U;
      sum ^= sum >> 29;
    }
    return sum;
  }

  void grow() {
    slots_.assign(slots_.empty() ? 1024 : 2 * slots_.size(), empty);
    for (std::uint32_t number = 0; number < read_.places.size(); ++number) {
      std::size_t slot = hash(read_.places[number]);
      while (slots_[slot & (slots_.size() - 1)] != empty) ++slot;
      slots_[slot & (slots_.size() - 1)] = number;
    }
  }

  Read& read_;
  std::vector<std::uint32_t> slots_;
};

std::uint64_t announced(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

void read_binary(std::string_view bytes, Corners& corners, Read& read) {
  bytes.remove_prefix(header_size);
  for (; bytes.size() >= facet_size; bytes.remove_prefix(facet_size)) {
    float numbers[12];  // the facet's normal, which is not needed, and its corners
    std::memcpy(numbers, bytes.data(), sizeof numbers);
    std::uint32_t corner[3];
    for (std::size_t k = 0; k < 3; ++k)
      corner[k] = corners.add({numbers[3 * k + 3], numbers[3 * k + 4], numbers[3 * k + 5]});
    read.add_triangle(corner[0], corner[1], corner[2], 0);
  }
}

/// Words, in any case and on any lines. What follows `solid` and `endsolid` in their lines is a name.
class Text {
 public:
  Text(std::string_view text, Corners& corners, Read& read)
      : all_(text), left_(text), corners_(corners), read_(read) {}

  void read() {
    bool ended = false;
    for (std::string word = next(); !word.empty(); word = next()) {
      ended = word == "endsolid";
      if (word == "solid" || ended) {
        left_.remove_prefix(std::min(left_.find('\n'), left_.size()));
      } else if (word == "facet") {
        read_facet();
      } else {
        fail("expected 'facet' or 'endsolid'");
      }
    }
    if (!ended) throw std::runtime_error("it is cut short: it does not end with 'endsolid'");
  }

 private:
  std::string next() { return lower(next_word(left_)); }

  [[noreturn]] void fail(const std::string& what) const {
    const std::string_view before = all_.substr(0, all_.size() - left_.size());
    throw std::runtime_error("line " + std::to_string(1 + std::count(before.begin(), before.end(), '\n')) +
                             ": " + what);
  }

  Triple numbers() {
    Triple its{};
    for (double& x : its)
      if (!is_number(next_word(left_), x)) fail("expected three finite numbers");
    return its;
  }

  /// The facet's own normal is not needed, and may be anything or missing.
  void read_facet() {
    polygon_.clear();
    std::string word = next();
    if (word == "normal") {
      for (int k = 0; k < 3; ++k) next_word(left_);
      word = next();
    }
    if (word == "outer") word = next();
    if (word != "loop") fail("expected 'outer loop'");
    for (word = next(); word == "vertex"; word = next()) polygon_.push_back(corners_.add(numbers()));
    if (word != "endloop") fail("expected 'vertex' or 'endloop'");
    if (next() != "endfacet") fail("expected 'endfacet'");
    if (polygon_.size() < 3) fail("a facet has less than three corners");
    read_.add_polygon(polygon_, 0);
  }

  std::string_view all_, left_;
  Corners& corners_;
  Read& read_;
  std::vector<std::uint32_t> polygon_;
};

}  // namespace

Read read_stl(const std::string& path) {
  const FileBytes file(path);
  const std::string_view bytes = file.view();
  Read read;
  read.materials.emplace_back();
  Corners corners(read);
  // The headers of many binary files begin with "solid", as text does: their size tells what they are.
  const bool has_count = bytes.size() >= header_size;
  const std::uint64_t wanted = has_count ? header_size + facet_size * announced(bytes) : 0;
  std::string_view start = bytes.substr(0, 4096);
  const bool is_text = lower(next_word(start)) == "solid";
  if (has_count && (wanted == bytes.size() || (!is_text && wanted < bytes.size()))) {
    read_binary(bytes.substr(0, wanted), corners, read);
  } else if (is_text) {
    Text(bytes, corners, read).read();
  } else if (has_count) {
    throw std::runtime_error("it says that it has " + std::to_string(announced(bytes)) +
                             " triangles, and has " + std::to_string(bytes.size()) + " bytes");
  } else {
    throw std::runtime_error("it is no STL file");
  }
  read.finish();
  return read;
}

}  // namespace backlight::models
