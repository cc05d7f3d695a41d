#include "backlight/film/assemble.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace backlight {
namespace {

constexpr int band_rows = 64;

using Planes = std::vector<std::vector<float>>;

std::vector<std::span<const float>> views_of(const Planes& planes) {
  return {planes.begin(), planes.end()};
}

// The last word of a channel's name tells colour from data: "R", "right.R", but "P.X".
bool is_colour(const std::string& channel) {
  static const std::set<std::string> colours{"R", "G", "B", "A"};
  const std::size_t dot = channel.rfind('.');
  return colours.contains(dot == std::string::npos ? channel : channel.substr(dot + 1));
}

/// The image's rows, from top to bottom, out of the parts that have them.
class RowSource {
 public:
  RowSource(const std::vector<ImagePart>& parts, const ImageLayout& layout)
      : parts_(parts), layout_(layout) {}

  /// Rows first <= j < end into planes of the whole width. What went wrong is in the result.
  Assembly read(int first, int end, Planes& planes) {
    const auto width = static_cast<std::size_t>(layout_.data.width());
    const std::size_t pixels = width * static_cast<std::size_t>(end - first);
    planes.resize(layout_.channels.size());
    for (std::vector<float>& plane : planes) plane.resize(pixels);
    source_.assign(pixels, no_part);
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      const PixelBox& box = parts_[part].info.layout.data;
      const int from = std::max(first, box.y0);
      const int to = std::min(end, box.y1);
      if (from >= to) continue;
      if (auto read = read_part(part, from, to); !read.ok())
        return {Assembly::End::file_trouble, read.error()};
      if (auto conflict = copy(part, first, from, to, planes); !conflict.empty()) {
        return {Assembly::End::misfit, std::move(conflict)};
      }
      if (box.y1 <= end) readers_.erase(part);
    }
    return {};
  }

 private:
  static constexpr std::size_t no_part = ~std::size_t{0};

  Result<void> read_part(std::size_t part, int from, int to) {
    auto reader = readers_.find(part);
    if (reader == readers_.end()) {
      auto opened = ExrReader::open(parts_[part].file);
      if (!opened.ok()) return opened.failure();
      if (opened.value().info().layout.data != parts_[part].info.layout.data) {
        return Failure{"cannot read " + parts_[part].file.string() + ": it has just been changed"};
      }
      reader = readers_.emplace(part, std::move(opened).value()).first;
    }
    const PixelBox& box = parts_[part].info.layout.data;
    rows_.resize(layout_.channels.size());
    std::vector<std::span<float>> spans;
    for (std::vector<float>& plane : rows_) {
      plane.resize(static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(to - from));
      spans.emplace_back(plane);
    }
    return reader->second.read_rows(from, to - from, spans);
  }

  /// The rows just read into planes that begin with row `first`; or where they contradict another part.
  std::string copy(std::size_t part, int first, int from, int to, Planes& planes) {
    const PixelBox& box = parts_[part].info.layout.data;
    const auto box_width = static_cast<std::size_t>(box.width());
    for (int y = from; y < to; ++y) {
      const std::size_t source_row = static_cast<std::size_t>(y - from) * box_width;
      const std::size_t target_row =
          static_cast<std::size_t>(y - first) * static_cast<std::size_t>(layout_.data.width()) +
          static_cast<std::size_t>(box.x0 - layout_.data.x0);
      for (std::size_t x = 0; x < box_width; ++x) {
        std::size_t& source = source_[target_row + x];
        for (std::size_t channel = 0; channel < planes.size(); ++channel) {
          const float value = rows_[channel][source_row + x];
          float& target = planes[channel][target_row + x];
          if (source != no_part &&
              std::bit_cast<std::uint32_t>(target) != std::bit_cast<std::uint32_t>(value))
            return parts_[part].file.string() + " and " + parts_[source].file.string() +
                   " differ in a pixel that both have: " + layout_.channels[channel].name + " at " +
                   std::to_string(box.x0 + static_cast<int>(x)) + "," + std::to_string(y) + " is " +
                   std::to_string(value) + " and " + std::to_string(target);
          target = value;
        }
        source = part;
      }
    }
    return {};
  }

  const std::vector<ImagePart>& parts_;
  const ImageLayout& layout_;
  std::map<std::size_t, ExrReader> readers_;  ///< of the parts that reach into this band and beyond it
  Planes rows_;
  std::vector<std::size_t> source_;  ///< which part each pixel of the band came from
};

/// Calls `use(planes, rows)` for each band, until one fails.
template <typename Use>
Assembly for_each_band(const std::vector<ImagePart>& parts, const ImageLayout& layout, Use use) {
  RowSource source(parts, layout);
  Planes planes;
  for (int first = layout.data.y0; first < layout.data.y1; first += band_rows) {
    const int end = std::min(first + band_rows, layout.data.y1);
    Assembly read = source.read(first, end, planes);
    if (read.end != Assembly::End::written) return read;
    if (const Result<void> used = use(planes, end - first); !used.ok()) {
      return {Assembly::End::file_trouble, used.error()};
    }
  }
  return {};
}

void narrow_colour(ImageLayout& layout) {
  for (ChannelInfo& channel : layout.channels) {
    if (is_colour(channel.name)) channel.precision = ChannelPrecision::half;
  }
}

}  // namespace

Assembly assemble_exr(const std::filesystem::path& output, const std::vector<ImagePart>& parts, bool narrow) {
  if (std::string misfit = misfit_of(parts); !misfit.empty()) {
    return {Assembly::End::misfit, std::move(misfit)};
  }
  ImageLayout layout = parts.front().info.layout;
  layout.data = layout.display;

  // All parts are read once before the first row is written: only then is it known whether half is enough.
  bool fits = true;
  Assembly looked = for_each_band(parts, layout, [&](const Planes& planes, int /*rows*/) -> Result<void> {
    for (std::size_t channel = 0; channel < planes.size(); ++channel) {
      if (is_colour(layout.channels[channel].name)) {
        fits = fits && std::ranges::all_of(planes[channel], fits_half);
      }
    }
    return {};
  });
  if (looked.end != Assembly::End::written) return looked;
  if (narrow && fits) narrow_colour(layout);

  auto writer = ExrWriter::open(output, layout, parts.front().info.header);
  if (!writer.ok()) return {Assembly::End::file_trouble, writer.error()};
  Assembly written = for_each_band(parts, layout, [&writer](const Planes& planes, int rows) {
    return writer.value().write_rows(views_of(planes), rows);
  });
  if (written.end != Assembly::End::written) return written;
  if (const auto committed = writer.value().commit(); !committed.ok()) {
    return {Assembly::End::file_trouble, committed.error()};
  }
  return {};
}

}  // namespace backlight
