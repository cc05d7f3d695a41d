#include "backlight/film/image.h"

#include <ImfMultiView.h>
#include <sys/mman.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

namespace backlight {
namespace {

// A block of pixels is a few bytes of each of its rows, and each of those is on a page of its own: with pages
// of 2 MB instead of 4 kB their addresses are found without a walk through tables. Memory that was never
// touched, of at least a few such pages; the system may refuse, and then all is as it was.
void ask_for_large_pages(float* begin, std::size_t bytes) {
  constexpr std::size_t page = 4096, few = std::size_t{4} << 20;
  if (bytes < few) return;
  const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(begin) % page) % page;
  static_cast<void>(madvise(reinterpret_cast<char*>(begin) + before, bytes - before, MADV_HUGEPAGE));
}

}  // namespace

bool fits_half(float value) {
  return !std::isfinite(value) || std::abs(value) <= greatest_half;
}

// By the bits, in whose order the sizes of numbers are, and NaNs beyond all of them: a loop that compilers
// put into vectors, in which no step waits for the one before.
bool all_within(std::span<const float> values, float greatest) {
  const auto most = std::bit_cast<std::int32_t>(greatest);
  std::int32_t beyond = 0;
  for (const float value : values)
    beyond |= (std::bit_cast<std::int32_t>(value) & 0x7fffffff) > most ? -1 : 0;
  return beyond == 0;
}

std::string channel_name(std::string_view name, const std::vector<std::string>& views, std::size_t view) {
  if (views.empty()) {
    return std::string(name);
  }
  return Imf::insertViewName(std::string(name), views, static_cast<int>(view));
}

std::optional<std::string> plain_name(std::string_view channel, const std::vector<std::string>& views,
                                      std::size_t view) {
  const std::string name(channel);
  if (views.empty()) return name;
  if (view >= views.size() || Imf::viewFromChannelName(name, views) != views[view]) return std::nullopt;
  return Imf::removeViewName(name, views[view]);
}

std::vector<ChannelInfo> channels_of_views(const std::vector<ChannelInfo>& base,
                                           const std::vector<std::string>& views) {
  if (views.empty()) {
    return base;
  }
  std::vector<ChannelInfo> all;
  for (std::size_t view = 0; view < views.size(); ++view) {
    for (const ChannelInfo& channel : base) {
      all.push_back({channel_name(channel.name, views, view), channel.precision});
    }
  }
  return all;
}

Image::Image(ImageLayout layout, std::vector<std::vector<float>> planes)
    : layout_(std::move(layout)), planes_(std::move(planes)) {}

Image::Image(ImageLayout layout) : layout_(std::move(layout)) {
  const std::size_t pixels = layout_.data.empty() ? 0
                                                  : static_cast<std::size_t>(layout_.data.width()) *
                                                        static_cast<std::size_t>(layout_.data.height());
  planes_.resize(layout_.channels.size());
  for (std::vector<float>& plane : planes_) {
    plane.reserve(pixels);
    ask_for_large_pages(plane.data(), pixels * sizeof(float));
    plane.resize(pixels);
  }
}

std::span<const std::uint32_t> Image::whole_numbers(std::size_t channel) const {
  const auto found = whole_numbers_.find(channel);
  return found == whole_numbers_.end() ? std::span<const std::uint32_t>() : std::span(found->second);
}

void Image::set_whole_numbers(std::size_t channel, std::vector<std::uint32_t> values) {
  whole_numbers_[channel] = std::move(values);
}

int Image::find_channel(std::string_view name) const {
  for (std::size_t channel = 0; channel < layout_.channels.size(); ++channel) {
    if (layout_.channels[channel].name == name) {
      return static_cast<int>(channel);
    }
  }
  return -1;
}

}  // namespace backlight
