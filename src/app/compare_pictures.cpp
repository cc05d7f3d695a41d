#include "compare_pictures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "backlight/film/exposure.h"
#include "backlight/film/false_colour.h"

namespace backlight {
namespace {

constexpr int widest = 960;
constexpr double heat_decades = 6.0;

// One channel's values, made smaller by taking blocks of `factor` x `factor` pixels together.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<float> values;
};

template <class Value, class Join>
Plane reduced(const PixelBox& box, int factor, float start, const Value& value, const Join& join) {
  Plane plane{(box.width() + factor - 1) / factor, (box.height() + factor - 1) / factor, {}};
  plane.values.assign(static_cast<std::size_t>(plane.width) * static_cast<std::size_t>(plane.height), start);
  for (int y = 0; y < box.height(); ++y) {
    for (int x = 0; x < box.width(); ++x) {
      const auto i = static_cast<std::size_t>(y / factor) * static_cast<std::size_t>(plane.width) +
                     static_cast<std::size_t>(x / factor);
      plane.values[i] = join(plane.values[i], value(x + box.x0, y + box.y0));
    }
  }
  return plane;
}

int factor_of(const PixelBox& box) {
  return std::max(1, (box.width() + widest - 1) / widest);
}

// The mean of each block, in linear light.
Plane mean_plane(const Image& image, std::size_t channel) {
  const PixelBox& box = image.layout().data;
  const int factor = factor_of(box);
  Plane plane = reduced(
      box, factor, 0.0F, [&](int x, int y) { return image.at(channel, x, y); },
      [](float sum, float one) { return sum + one; });
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      const int wide = std::min(factor, box.width() - x * factor);
      const int high = std::min(factor, box.height() - y * factor);
      plane.values[static_cast<std::size_t>(y * plane.width + x)] /= static_cast<float>(wide * high);
    }
  }
  return plane;
}

Result<std::string> colour_picture(const Image& image, std::size_t view, const DisplayTransform& transform) {
  ImageLayout layout;
  layout.channels = {{"R", {}}, {"G", {}}, {"B", {}}};
  std::vector<std::vector<float>> planes;
  const auto channels = colour_channels(image, view);
  if (!channels.ok()) return channels.failure();
  for (const std::size_t channel : channels.value()) {
    Plane plane = mean_plane(image, channel);
    layout.data = layout.display = {0, 0, plane.width, plane.height};
    planes.push_back(std::move(plane.values));
  }
  const auto shown = display_image(Image(layout, std::move(planes)), transform);
  return shown.ok() ? png_address(shown.value().pixels) : Result<std::string>(shown.failure());
}

// A data channel from the least to the greatest value of the reference.
Result<std::string> data_picture(const Image& image, std::size_t channel, double least, double greatest) {
  const PixelBox& box = image.layout().data;
  Plane plane = reduced(
      box, factor_of(box), std::numeric_limits<float>::quiet_NaN(),
      [&](int x, int y) { return image.at(channel, x, y); },
      [](float kept, float one) { return std::isnan(kept) ? one : kept; });
  for (float& value : plane.values) {
    if (std::isfinite(value)) {
      value = static_cast<float>((double(value) - least) / std::max(greatest - least, 1e-30));
    }
  }
  const auto colours = false_colours(plane.values, plane.width, plane.height, ColourMap::viridis);
  return colours.ok() ? png_address(colours.value()) : Result<std::string>(colours.failure());
}

// Fills in the heat map: logarithmic, over `heat_decades` below the greatest difference.
Result<void> add_heat(ReportPicture& picture, const CompareOutcome& outcome,
                      const std::vector<std::size_t>& channels) {
  const Image& a = outcome.reference->image;
  const Image& b = outcome.now->image;
  const auto difference = [&](int x, int y) {
    double greatest = 0.0;
    for (const std::size_t i : channels) {
      greatest = std::max(greatest, value_difference(a.at(i, x, y), b.at(i, x, y)));
    }
    if (std::isfinite(greatest)) picture.heat_max = std::max(picture.heat_max, greatest);
    picture.strange |= std::isinf(greatest);
    return static_cast<float>(greatest);
  };
  const PixelBox& box = a.layout().data;
  double worst = 0.0;
  Plane plane = reduced(
      box, factor_of(box), 0.0F,
      [&](int x, int y) {
        const float one = difference(x, y);
        if (double(one) > worst) {
          worst = double(one);
          picture.worst_x = x;
          picture.worst_y = y;
        }
        return one;
      },
      [](float kept, float one) { return std::max(kept, one); });
  if (worst == 0.0) return {};
  for (float& value : plane.values) {
    if (!std::isfinite(value)) continue;
    const double decades = value > 0.0F ? std::log10(double(value) / picture.heat_max) : -heat_decades;
    value = static_cast<float>(1.0 + std::max(decades, -heat_decades) / heat_decades);
  }
  const auto colours = false_colours(plane.values, plane.width, plane.height, ColourMap::inferno);
  if (!colours.ok()) return colours.failure();
  auto address = png_address(colours.value());
  if (!address.ok()) return address.failure();
  picture.heat = std::move(address).value();
  return {};
}

// Draws the reference's and the new picture by `draw`.
template <class Draw>
Result<ReportPicture> picture_of(const CompareOutcome& outcome, std::string label,
                                 const std::vector<std::size_t>& channels, const Draw& draw) {
  ReportPicture picture;
  picture.label = std::move(label);
  const PixelBox& box = (outcome.now ? *outcome.now : *outcome.reference).image.layout().data;
  const int factor = factor_of(box);
  picture.width = (box.width() + factor - 1) / factor;
  picture.height = (box.height() + factor - 1) / factor;
  const auto put = [&draw](const std::optional<ExrPicture>& from, std::string& address) -> Result<void> {
    if (!from) return {};
    auto drawn = draw(from->image);
    if (!drawn.ok()) return drawn.failure();
    address = std::move(drawn).value();
    return {};
  };
  if (const auto done = put(outcome.reference, picture.reference); !done.ok()) return done.failure();
  if (const auto done = put(outcome.now, picture.now); !done.ok()) return done.failure();
  if (!outcome.difference) return picture;
  if (const auto done = add_heat(picture, outcome, channels); !done.ok()) return done.failure();
  return picture;
}

bool differs(const ImageDifference& difference, const std::string& name) {
  return std::any_of(
      difference.channels.begin(), difference.channels.end(),
      [&name](const ChannelDifference& channel) { return channel.name == name && channel.maximum > 0.0; });
}

std::pair<double, double> range_of(std::span<const float> values) {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -least;
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    least = std::min(least, double(value));
    greatest = std::max(greatest, double(value));
  }
  return {least, greatest};
}

}  // namespace

Result<std::vector<ReportPicture>> report_pictures(const CompareOutcome& outcome) {
  std::vector<ReportPicture> pictures;
  if (!outcome.reference && !outcome.now) return pictures;
  const Image& first = (outcome.reference ? *outcome.reference : *outcome.now).image;
  const std::vector<std::string>& views = first.layout().views;
  std::vector<std::size_t> shown;
  for (std::size_t view = 0; view < std::max<std::size_t>(1, views.size()); ++view) {
    const auto found = colour_channels(first, view);
    LuminanceCounts counts;
    if (!found.ok() || !counts.add(first, view).ok()) continue;  // a picture of data alone
    const std::vector<std::size_t> channels(found.value().begin(), found.value().end());
    shown.insert(shown.end(), channels.begin(), channels.end());
    const DisplayTransform transform = automatic_transform(counts);
    // Pictures of different layouts are each shown by their own channels.
    auto picture = picture_of(outcome, views.size() < 2 ? "colour" : "colour, " + views[view], channels,
                              [&](const Image& image) { return colour_picture(image, view, transform); });
    if (!picture.ok()) return picture.failure();
    pictures.push_back(std::move(picture).value());
  }
  if (!outcome.difference) return pictures;
  for (std::size_t i = 0; i < first.channel_count(); ++i) {
    const std::string& name = first.layout().channels[i].name;
    if (std::find(shown.begin(), shown.end(), i) != shown.end() || !differs(*outcome.difference, name)) {
      continue;
    }
    const auto [least, greatest] = range_of(first.plane(i));
    auto picture = picture_of(outcome, name, {i}, [&, low = least, high = greatest](const Image& image) {
      return data_picture(image, i, low, high);
    });
    if (!picture.ok()) return picture.failure();
    pictures.push_back(std::move(picture).value());
  }
  return pictures;
}

}  // namespace backlight
