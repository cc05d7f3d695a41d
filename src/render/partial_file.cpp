#include "backlight/render/partial_file.h"

#include <algorithm>
#include <utility>

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

ExrHeader incomplete(ExrHeader header) {
  std::erase_if(header.attributes,
                [](const ExrAttribute& attribute) { return attribute.name == "backlight/complete"; });
  header.attributes.push_back({"backlight/complete", std::int32_t{0}});
  return header;
}

// The plane of the file for each channel of the image, then for each view's mask; empty if one is missing.
std::vector<std::size_t> planes_of(const Image& stored, const ImageLayout& layout, std::size_t views) {
  std::vector<std::size_t> planes;
  for (const ChannelInfo& channel : stored_layout(layout, views).channels) {
    const int found = stored.find_channel(channel.name);
    if (found < 0) return {};
    planes.push_back(static_cast<std::size_t>(found));
  }
  return planes;
}

}  // namespace

std::filesystem::path partial_path(const std::filesystem::path& exr) {
  return std::filesystem::path(exr).replace_extension(".partial.exr");
}

Result<void> write_partial(const std::filesystem::path& path, const PartialImage& partial,
                           const ExrHeader& header) {
  const Image& image = partial.image;
  const ImageLayout layout = stored_layout(image.layout(), partial.done.size());
  auto writer = ExrWriter::open(path, layout, incomplete(header));
  if (!writer.ok()) return writer.failure();
  std::vector<std::vector<float>> masks;
  for (const auto& done : partial.done) masks.emplace_back(done.begin(), done.end());
  std::vector<std::span<const float>> planes;
  for (std::size_t i = 0; i < image.channel_count(); ++i) planes.push_back(image.plane(i));
  planes.insert(planes.end(), masks.begin(), masks.end());
  if (auto written = writer.value().write_rows(planes, layout.data.height()); !written.ok()) return written;
  return writer.value().commit();
}

Result<void> read_partial(const std::filesystem::path& path, const std::string& identity,
                          PartialImage& partial) {
  const auto read = read_exr(path);
  if (!read.ok()) return read.failure();
  const auto& [stored, header] = read.value();
  const auto* found = header.find<std::string>(identity_attribute);
  if (found == nullptr || *found != identity) {
    return Failure{path.string() + " was made from another scene or with other settings"};
  }
  const ImageLayout& layout = partial.image.layout();
  const std::vector<std::size_t> planes = planes_of(stored, layout, partial.done.size());
  if (planes.empty() || stored.layout().data != layout.data) {
    return Failure{path.string() + " does not have the channels and pixels of a partial image"};
  }
  for (std::size_t i = 0; i < layout.channels.size(); ++i) {
    std::ranges::copy(stored.plane(planes[i]), partial.image.plane(i).begin());
  }
  for (std::size_t view = 0; view < partial.done.size(); ++view) {
    std::ranges::transform(stored.plane(planes[layout.channels.size() + view]), partial.done[view].begin(),
                           [](float is_done) { return static_cast<std::uint8_t>(is_done == 1.0F); });
  }
  return {};
}

}  // namespace backlight
