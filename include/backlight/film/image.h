// A picture in memory: named channels of floats over a window of pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace backlight {

/// Pixels (i, j) with x0 <= i < x1 and y0 <= j < y1; j counts downwards.
struct PixelBox {
  int x0 = 0;
  int y0 = 0;
  int x1 = 0;
  int y1 = 0;

  [[nodiscard]] int width() const { return x1 - x0; }
  [[nodiscard]] int height() const { return y1 - y0; }
  [[nodiscard]] bool empty() const { return x1 <= x0 || y1 <= y0; }
  [[nodiscard]] bool contains(int i, int j) const { return i >= x0 && i < x1 && j >= y0 && j < y1; }
  bool operator==(const PixelBox&) const = default;
};

/// How a channel is stored in a file. In memory it is float in any case.
enum class ChannelPrecision {
  half,    ///< 11 significant bits, up to 65504: colour
  single,  ///< float: distances, times, positions, identifiers
  whole    ///< unsigned integers of 32 bits: other programs' identifiers. Only read, never written
};

/// Whether half precision can hold the value: up to 65504. Infinities and NaNs have their counterparts in
/// half.
bool fits_half(float value);

/// Whether every value lies within ±`greatest`; one that is not a number does not.
bool all_within(std::span<const float> values, float greatest);

/// The greatest number in half precision.
inline constexpr float greatest_half = 65504.0F;

/// A channel's name as in the file ("R", "Z", "doppler.D", "P.X"...) and its storage.
struct ChannelInfo {
  std::string name;
  ChannelPrecision precision = ChannelPrecision::single;
  bool operator==(const ChannelInfo&) const = default;
};

/// What a picture consists of, without its pixels.
struct ImageLayout {
  PixelBox display;                   ///< the whole picture
  PixelBox data;                      ///< the part of it that has pixels: a crop, or the same as `display`
  std::vector<ChannelInfo> channels;  ///< no two of one name; the order is the caller's
  std::vector<std::string> views;     ///< {"left", "right"} for stereo; empty for one view
};

/// The name in the file of channel `name` of view number `view`, by OpenEXR's multi-view rules
/// (Imf::insertViewName). The first view is the default one: its channels without a layer keep their plain
/// names ("R"; "right.R" in the other). Channels with a layer carry the view in both: "doppler.left.D".
std::string channel_name(std::string_view name, const std::vector<std::string>& views, std::size_t view);

/// The name without the view, of a channel of view number `view`: "doppler.D". Nothing where the channel is
/// none of that view's. The inverse of channel_name.
std::optional<std::string> plain_name(std::string_view channel, const std::vector<std::string>& views,
                                      std::size_t view);

/// The channels `base` for each of `views`, view after view, with the views' names inserted.
std::vector<ChannelInfo> channels_of_views(const std::vector<ChannelInfo>& base,
                                           const std::vector<std::string>& views);

/// A layout and its pixels: each channel a plane of data.width() * data.height() floats, row after row from
/// the top. Different threads may write different pixels.
class Image {
 public:
  Image() = default;
  /// All pixels 0.
  explicit Image(ImageLayout layout);
  /// With the pixels of each channel given. Each plane must be of the data window's size.
  Image(ImageLayout layout, std::vector<std::vector<float>> planes);

  [[nodiscard]] const ImageLayout& layout() const { return layout_; }
  [[nodiscard]] std::size_t channel_count() const { return planes_.size(); }

  /// The same pixels at another place: a window of the same size.
  void move_to(const PixelBox& data) { layout_.data = data; }

  /// The number of the channel called `name`, or -1.
  [[nodiscard]] int find_channel(std::string_view name) const;

  [[nodiscard]] std::span<float> plane(std::size_t channel) { return planes_[channel]; }
  [[nodiscard]] std::span<const float> plane(std::size_t channel) const { return planes_[channel]; }

  /// The values of a channel of whole numbers, of which its plane has the nearest floats: a float holds them
  /// exactly up to 2^24 only. Empty for every other channel.
  [[nodiscard]] std::span<const std::uint32_t> whole_numbers(std::size_t channel) const;
  void set_whole_numbers(std::size_t channel, std::vector<std::uint32_t> values);

  /// The value at pixel (i, j) of the whole picture, which must lie in the data window.
  [[nodiscard]] float& at(std::size_t channel, int i, int j) { return planes_[channel][offset(i, j)]; }
  [[nodiscard]] float at(std::size_t channel, int i, int j) const { return planes_[channel][offset(i, j)]; }

  /// Where pixel (i, j) of the whole picture is in each plane.
  [[nodiscard]] std::size_t offset(int i, int j) const {
    return static_cast<std::size_t>(j - layout_.data.y0) * static_cast<std::size_t>(layout_.data.width()) +
           static_cast<std::size_t>(i - layout_.data.x0);
  }

 private:
  ImageLayout layout_;
  std::vector<std::vector<float>> planes_;
  std::map<std::size_t, std::vector<std::uint32_t>> whole_numbers_;
};

}  // namespace backlight
