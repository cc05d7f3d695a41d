#include "backlight/render/partial_file.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "backlight/render/image_identity.h"

namespace backlight {
namespace {

std::string mask_name(const ImageLayout& layout, std::size_t view) {
  return channel_name("rendered.V", layout.views, view);
}

ImageLayout stored_layout(ImageLayout layout, std::size_t views) {
  for (ChannelInfo& channel : layout.channels) channel.precision = ChannelPrecision::single;
  for (std::size_t view = 0; view < views; ++view) {
    layout.channels.push_back({mask_name(layout, view), ChannelPrecision::single});
  }
  return layout;
}

constexpr const char* colour_attribute = "backlight/colour";

ExrHeader incomplete(ExrHeader header, const PartialImage& partial, const ImageFile* file) {
  std::erase_if(header.attributes,
                [](const ExrAttribute& attribute) { return attribute.name == "backlight/complete"; });
  header.attributes.push_back({"backlight/complete", std::int32_t{0}});
  if (file != nullptr && !partial.keeps_rows())
    header.attributes.push_back({colour_attribute, std::string(file->is_half() ? "half" : "float")});
  return header;
}

using Planes = std::vector<std::vector<float>>;

// Those of a band of some layout.
Planes empty_planes(const ImageLayout& layout, const PixelBox& window) {
  const auto pixels = static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
  return Planes(layout.channels.size(), std::vector<float>(pixels, 0.0F));
}

// Whether all colours of a view's pixel fit into half.
bool fits(const ImageLayout& layout, const Planes& planes, std::size_t view, std::size_t pixel) {
  const std::size_t count = layout.channels.size() / std::max<std::size_t>(layout.views.size(), 1);
  for (std::size_t channel = view * count; channel < (view + 1) * count; ++channel) {
    if (layout.channels[channel].precision == ChannelPrecision::half && !fits_half(planes[channel][pixel]))
      return false;
  }
  return true;
}

// What is done of a band, and the views' masks behind it. A pixel that does not fit into half, where the rows
// above are rounded to it, is left to be traced again: all of the image then is.
void copy_done(const RowBand& band, bool is_half, Planes& planes) {
  const ImageLayout& layout = band.image.layout();
  const std::size_t channels = layout.channels.size() / band.done.size();
  for (std::size_t channel = 0; channel < layout.channels.size(); ++channel)
    std::ranges::copy(band.image.plane(channel), planes[channel].begin());
  for (std::size_t view = 0; view < band.done.size(); ++view) {
    std::vector<float>& mask = planes[layout.channels.size() + view];
    for (std::size_t pixel = 0; pixel < mask.size(); ++pixel) {
      const bool is_done = band.done[view][pixel] != 0 && (!is_half || fits(layout, planes, view, pixel));
      mask[pixel] = is_done ? 1.0F : 0.0F;
      for (std::size_t i = 0; i < channels && !is_done; ++i) planes[view * channels + i][pixel] = 0.0F;
    }
  }
}

Result<void> read_released(std::size_t band, ImageFile& file, std::size_t channels, Planes& planes) {
  for (std::size_t plane = channels; plane < planes.size(); ++plane) std::ranges::fill(planes[plane], 1.0F);
  const std::vector<std::span<float>> targets(planes.begin(),
                                              planes.begin() + static_cast<std::ptrdiff_t>(channels));
  return file.read_back(band, targets);
}

// The place in the file of each channel of the image, then of each view's mask; empty if one is missing.
std::vector<std::size_t> places_of(const ImageLayout& stored, const ImageLayout& layout, std::size_t views) {
  std::vector<std::size_t> places;
  for (const ChannelInfo& channel : stored_layout(layout, views).channels) {
    const auto found = std::ranges::find(stored.channels, channel.name, &ChannelInfo::name);
    if (found == stored.channels.end()) return {};
    places.push_back(static_cast<std::size_t>(found - stored.channels.begin()));
  }
  return places;
}

// Whether a mask, of those behind the channels, tells of a pixel that is done.
bool has_any(const Planes& planes, const std::vector<std::size_t>& places, std::size_t channels) {
  return std::any_of(
      places.begin() + static_cast<std::ptrdiff_t>(channels), places.end(),
      [&](std::size_t place) { return std::ranges::find(planes[place], 1.0F) != planes[place].end(); });
}

// `planes`: as in the file, of which the image's are those at `places`.
void put(const Planes& planes, const std::vector<std::size_t>& places, RowBand& band) {
  const std::size_t channels = band.image.channel_count();
  for (std::size_t channel = 0; channel < channels; ++channel)
    std::ranges::copy(planes[places[channel]], band.image.plane(channel).begin());
  std::size_t done = 0;
  for (std::size_t view = 0; view < band.done.size(); ++view) {
    std::ranges::transform(planes[places[channels + view]], band.done[view].begin(),
                           [](float is_done) { return static_cast<std::uint8_t>(is_done == 1.0F); });
    done += static_cast<std::size_t>(std::ranges::count(band.done[view], 1));
  }
  band.missing -= done;
}

}  // namespace

std::filesystem::path partial_path(const std::filesystem::path& exr) {
  return std::filesystem::path(exr).replace_extension(".partial.exr");
}

Result<void> write_partial(const std::filesystem::path& path, const PartialImage& partial,
                           const ExrHeader& header, ImageFile* file) {
  const std::size_t channels = partial.layout().channels.size();
  const ImageLayout layout = stored_layout(partial.layout(), partial.view_count());
  auto writer = ExrWriter::open(path, layout, incomplete(header, partial, file));
  if (!writer.ok()) return writer.failure();
  const bool is_half = file != nullptr && !partial.keeps_rows() && file->is_half();
  for (std::size_t band = 0; band < partial.band_count(); ++band) {
    Planes planes = empty_planes(layout, partial.band_window(band));
    if (const RowBand* begun = partial.find(band)) {
      copy_done(*begun, is_half, planes);
    } else if (partial.was_released(band)) {
      if (auto read = read_released(band, *file, channels, planes); !read.ok()) return read;
    }
    const std::vector<std::span<const float>> views(planes.begin(), planes.end());
    if (auto written = writer.value().write_rows(views, partial.band_window(band).height()); !written.ok())
      return written;
  }
  return writer.value().commit();
}

Result<void> read_partial(const std::filesystem::path& path, const std::string& identity,
                          PartialImage& partial, ImageFile* file) {
  auto opened = ExrReader::open(path);
  if (!opened.ok()) return opened.failure();
  ExrReader& reader = opened.value();
  const auto& [stored, header] = std::tie(reader.info().layout, reader.info().header);
  const auto* found = header.find<std::string>(identity_attribute);
  if (found == nullptr || *found != identity) {
    return Failure{path.string() + " was made from another scene or with other settings"};
  }
  const std::vector<std::size_t> places = places_of(stored, partial.layout(), partial.view_count());
  if (places.empty() || stored.data != partial.layout().data) {
    return Failure{path.string() + " does not have the channels and pixels of a partial image"};
  }
  const auto* colour = header.find<std::string>(colour_attribute);
  if (file != nullptr && colour != nullptr && *colour == "float") file->begin_anew();
  for (std::size_t band = 0; band < partial.band_count(); ++band) {
    const PixelBox window = partial.band_window(band);
    Planes planes = empty_planes(stored, window);
    const std::vector<std::span<float>> targets(planes.begin(), planes.end());
    if (auto read = reader.read_rows(window.y0, window.height(), targets); !read.ok()) return read;
    if (!has_any(planes, places, partial.layout().channels.size())) continue;  // not begun
    put(planes, places, *partial.begin(band));
    if (file != nullptr) file->take_finished();
  }
  return {};
}

}  // namespace backlight
