#include "channels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "pixel_blocks.h"

namespace backlight {
namespace {

// One data channel: the key of `aovs` that asks for it, its name in the file, and its number of a record.
struct DataChannel {
  std::string_view aov;
  const char* name;
  double (*value)(const PixelData&);
  bool (*to_nothing)(const PixelData&) = nullptr;  // of a distance: whether it is infinite
};

using R = PixelData;
constexpr std::array data_channels{
    DataChannel{"Z", "Z", [](const R& r) { return r.surface.distance; },
                [](const R& r) { return r.surface.object_id == 0; }},
    DataChannel{"doppler", "doppler.D", [](const R& r) { return r.surface.doppler; }},
    DataChannel{"emissionTime", "emissionTime.T", [](const R& r) { return r.surface.emission_time; }},
    DataChannel{"properTime", "properTime.T", [](const R& r) { return r.surface.proper_time; }},
    DataChannel{"P", "P.X", [](const R& r) { return r.surface.position.x; }},
    DataChannel{"P", "P.Y", [](const R& r) { return r.surface.position.y; }},
    DataChannel{"P", "P.Z", [](const R& r) { return r.surface.position.z; }},
    DataChannel{"N", "N.X", [](const R& r) { return r.surface.normal.x; }},
    DataChannel{"N", "N.Y", [](const R& r) { return r.surface.normal.y; }},
    DataChannel{"N", "N.Z", [](const R& r) { return r.surface.normal.z; }},
    DataChannel{"objectId", "objectId.V",
                [](const R& r) { return static_cast<double>(r.surface.object_id); }},
    DataChannel{"unresolved", "unresolved.V", [](const R& r) { return r.surface.unresolved ? 1.0 : 0.0; }},
    DataChannel{"light", "light.N", [](const R& r) { return static_cast<double>(r.surface.lamps); }},
    DataChannel{"light", "light.Y", [](const R& r) { return r.surface.unshifted; }},
    DataChannel{"mirror", "mirror.Z", [](const R& r) { return r.surface.mirror.distance; },
                [](const R& r) { return r.surface.mirror.object_id == 0; }},
    DataChannel{"mirror", "mirror.D", [](const R& r) { return r.surface.mirror.doppler; }},
    DataChannel{"mirror", "mirror.T", [](const R& r) { return r.surface.mirror.emission_time; }},
    DataChannel{"mirror", "mirror.V",
                [](const R& r) { return static_cast<double>(r.surface.mirror.object_id); }},
    DataChannel{"samples", "samples.N", [](const R& r) { return static_cast<double>(r.samples); }},
};

// Of a channel for each light.
constexpr std::string_view lamp_time = "lampTime";

std::vector<ChannelInfo> channels_of_one_view(const Scene& scene) {
  std::vector<ChannelInfo> channels;
  for (const char* name : {"R", "G", "B", "A"}) channels.push_back({name, ChannelPrecision::half});
  for (const DataChannel& channel : data_channels) {
    if (has_aov(scene, channel.aov)) channels.push_back({channel.name, ChannelPrecision::single});
  }
  for (std::size_t i = 1; i <= scene.lights.size() && has_aov(scene, lamp_time); ++i)
    channels.push_back({std::string(lamp_time) + "." + std::to_string(i), ChannelPrecision::single});
  return channels;
}

}  // namespace

ImageLayout layout_of(const Scene& scene, const PixelBox& data_window) {
  ImageLayout layout;
  layout.display = {0, 0, scene.film.width, scene.film.height};
  layout.data = data_window;
  layout.channels = channels_of_one_view(scene);
  if (scene.camera.stereo) {
    layout.views = {"left", "right"};
    layout.channels = channels_of_views(layout.channels, layout.views);
  }
  return layout;
}

bool has_data_channels(const Scene& scene) {
  return !scene.film.aovs.empty();
}

bool has_light_channels(const Scene& scene) {
  return has_aov(scene, "light") || has_aov(scene, lamp_time);
}

LinearRgb saturated(const LinearRgb& rgb) {
  constexpr double most = std::numeric_limits<float>::max();
  const double greatest = std::max({std::abs(rgb.r), std::abs(rgb.g), std::abs(rgb.b)});
  const bool finite = std::isfinite(rgb.r) && std::isfinite(rgb.g) && std::isfinite(rgb.b);
  if (!finite || greatest <= most) return rgb;
  return glm::clamp(rgb * (most / greatest), -most, most);
}

PixelWriter::PixelWriter(const Scene& scene, Image& image, std::size_t view)
    : image_(&image),
      first_(view * image.channel_count() / std::max<std::size_t>(image.layout().views.size(), 1)) {
  for (std::size_t c = 0; c < 4; ++c) colour_[c] = image.plane(first_ + c).data();
  if (!has_data_channels(scene)) return;
  lamp_times_ = has_aov(scene, lamp_time);
  for (const DataChannel& channel : data_channels) {
    if (!has_aov(scene, channel.aov)) continue;
    data_.push_back({channel.value, channel.to_nothing});
  }
}

namespace {

// Of a block's red, green and blue as floats; returns how many of its pixels are not finite.
std::uint64_t saturate_block(float (&values)[4][block_pixels], const TileLight& light, std::size_t first) {
  const auto is_finite = [](const float(&of)[block_pixels]) {
    return all_within(of, std::numeric_limits<float>::max());
  };
  if (is_finite(values[0]) && is_finite(values[1]) && is_finite(values[2])) return 0;
  std::uint64_t non_finite = 0;
  for (std::size_t i = 0; i < block_pixels; ++i) {
    const LinearRgb rgb = saturated(light.colour(first + i));
    bool finite = true;
    for (int c = 0; c < 3; ++c) {
      values[c][i] = static_cast<float>(0.0 + rgb[c]);
      finite &= std::isfinite(values[c][i]);
    }
    non_finite += finite ? 0 : 1;
  }
  return non_finite;
}

}  // namespace

std::uint64_t PixelWriter::block(std::size_t at, std::size_t width, const TileLight& light,
                                 std::size_t first) const {
  float values[4][block_pixels];
  for (std::size_t c = 0; c < 3; ++c) {
    const double* const from = light.rgb[c].data() + first;
    for (std::size_t i = 0; i < block_pixels; ++i) values[c][i] = static_cast<float>(0.0 + from[i]);
  }
  const std::uint8_t* const covered = light.covered.data() + first;
  for (std::size_t i = 0; i < block_pixels; ++i) values[3][i] = static_cast<float>(covered[i]);
  const std::uint64_t non_finite = saturate_block(values, light, first);
  for (std::size_t c = 0; c < 4; ++c) {
    float* row = colour_[c] + at;
    for (const std::size_t first_of_row : {0U, 2U, 8U, 10U, 32U, 34U, 40U, 42U}) {
      // Of the block's order, each even pixel and the next one are neighbours in a row.
      const float* const pair = values[c] + first_of_row;
      std::memcpy(row, pair, 2 * sizeof(float));
      std::memcpy(row + 2, pair + 4, 2 * sizeof(float));
      std::memcpy(row + 4, pair + 16, 2 * sizeof(float));
      std::memcpy(row + 6, pair + 20, 2 * sizeof(float));
      row += width;
    }
  }
  return non_finite;
}

void PixelWriter::expect(std::size_t at, std::size_t columns) const {
  constexpr std::size_t line = 64 / sizeof(float);
  for (const float* plane : colour_) {
    for (std::size_t i = 0; i < columns; i += line) __builtin_prefetch(plane + at + i, 1);
    __builtin_prefetch(plane + at + columns - 1, 1);
  }
}

bool PixelWriter::data(int x, int y, const PixelData& data) const {
  bool finite = true;
  for (std::size_t i = 0; i < data_.size(); ++i) {
    const auto stored = static_cast<float>(data_[i].value(data));
    image_->at(first_ + 4 + i, x, y) = stored;
    finite &= std::isfinite(stored) || (data_[i].to_nothing != nullptr && data_[i].to_nothing(data));
  }
  for (std::size_t i = 0; lamp_times_ && i < data.lamp_times.size(); ++i) {
    const auto stored = static_cast<float>(data.lamp_times[i]);
    image_->at(first_ + 4 + data_.size() + i, x, y) = stored;
    finite &= std::isfinite(stored) || stored < 0.0F;
  }
  return finite;
}

}  // namespace backlight
