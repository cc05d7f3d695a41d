#include <algorithm>
#include <string>

#include "backlight/render/render.h"

namespace backlight {

SampleCounts& SampleCounts::operator+=(const SampleCounts& other) {
  if (other.pixels == 0) return *this;
  least = pixels == 0 ? other.least : std::min(least, other.least);
  most = std::max(most, other.most);
  pixels += other.pixels;
  total += other.total;
  at_limit += other.at_limit;
  return *this;
}

bool PartialImage::is_complete() const {
  const auto all = [](const std::vector<std::uint8_t>& plane) {
    return std::ranges::all_of(plane, [](std::uint8_t is_done) { return is_done != 0; });
  };
  return std::ranges::all_of(done, all);
}

bool PartialImage::has_any() const {
  const auto any = [](const std::vector<std::uint8_t>& plane) {
    return std::ranges::any_of(plane, [](std::uint8_t is_done) { return is_done != 0; });
  };
  return std::ranges::any_of(done, any);
}

PixelFailure::PixelFailure(int at_x, int at_y, const std::string& why)
    : std::runtime_error("pixel " + std::to_string(at_x) + "," + std::to_string(at_y) + ": " + why),
      x(at_x),
      y(at_y) {}

}  // namespace backlight
