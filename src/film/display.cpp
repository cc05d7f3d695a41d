#include "backlight/film/display.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace backlight {
namespace {

/// Stands for infinity in sums and quotients of channels.
constexpr double very_large = 1e60;

double luminance(const Vec3& rgb) {
  return 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b;
}

double least(const Vec3& rgb) {
  return std::min({rgb.r, rgb.g, rgb.b});
}
double greatest(const Vec3& rgb) {
  return std::max({rgb.r, rgb.g, rgb.b});
}

Vec3 without_negative_channels(const Vec3& rgb) {
  const double lowest = least(rgb);
  if (lowest >= 0.0) {
    return rgb;
  }
  const double grey = luminance(rgb);
  if (grey <= 0.0) {
    return Vec3{0.0};
  }
  const double share = grey / (grey - lowest);
  return glm::max(Vec3{grey} + share * (rgb - Vec3{grey}), Vec3{0.0});
}

/// Mixes a colour of luminance `grey` with that grey until no channel is above 1.
Vec3 within_white(const Vec3& rgb, double grey) {
  const double highest = greatest(rgb);
  if (highest <= 1.0) {
    return rgb;
  }
  if (grey >= 1.0) {
    return Vec3{1.0};
  }
  const double share = (1.0 - grey) / (highest - grey);
  return glm::min(Vec3{grey} + share * (rgb - Vec3{grey}), Vec3{1.0});
}

double curve(ToneCurve tone, double value, double white) {
  if (tone == ToneCurve::reinhard) {
    return value * (1.0 + value / (white * white)) / (1.0 + value);
  }
  if (tone == ToneCurve::drago) {
    const double bias = std::log(0.85) / std::log(0.5);
    const double base = 2.0 + 8.0 * std::pow(value / white, bias);
    return std::log1p(value) / std::log(base) / std::log10(1.0 + white);
  }
  return std::log1p(value) / std::log1p(white);
}

bool has_nan(const Vec3& rgb) {
  return std::isnan(rgb.r) || std::isnan(rgb.g) || std::isnan(rgb.b);
}

std::uint8_t to_byte(double linear) {
  return static_cast<std::uint8_t>(std::lround(255.0 * linear_to_srgb(linear)));
}

}  // namespace

double linear_to_srgb(double linear) {
  const double size = std::abs(linear);
  const double signal = size <= 0.0031308 ? 12.92 * size : 1.055 * std::pow(size, 1.0 / 2.4) - 0.055;
  return std::copysign(signal, linear);
}

double shown_value(double film) {
  constexpr double slope_at_white = 1.055 / 2.4;
  const double size = std::abs(film);
  if (size <= 1.0) return linear_to_srgb(film);
  return std::copysign(1.0 + slope_at_white * std::log(size), film);
}

double srgb_to_linear(double signal) {
  const double size = std::abs(signal);
  const double linear = size <= 0.04045 ? size / 12.92 : std::pow((size + 0.055) / 1.055, 2.4);
  return std::copysign(linear, signal);
}

Vec3 DisplayTransform::apply(const Vec3& film) const {
  if (has_nan(film)) {
    return Vec3{std::numeric_limits<double>::quiet_NaN()};
  }
  const Vec3 exposed = glm::clamp(film * std::exp2(exposure_stops), Vec3{-very_large}, Vec3{very_large});
  const Vec3 rgb = without_negative_channels(exposed);
  if (tone == ToneCurve::none) {
    return glm::min(rgb, Vec3{1.0});
  }
  const double before = luminance(rgb);
  if (before <= 0.0) {
    return Vec3{0.0};
  }
  const double after = curve(tone, before, white);
  return within_white(rgb * (after / before), after);
}

Result<std::array<std::size_t, 3>> colour_channels(const Image& image, std::size_t view) {
  const std::vector<std::string>& views = image.layout().views;
  if (view > 0 && view >= views.size()) {
    return Failure{"the picture has no view number " + std::to_string(view)};
  }
  std::array<std::size_t, 3> channels{};
  constexpr std::array<const char*, 3> names{"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    const int found = image.find_channel(channel_name(names[c], views, view));
    if (found < 0) {
      return Failure{"the picture has no channel " + channel_name(names[c], views, view)};
    }
    channels[c] = static_cast<std::size_t>(found);
  }
  return channels;
}

Result<DisplayedImage> display_image(const Image& image, const DisplayTransform& transform,
                                     std::size_t view) {
  const auto found = colour_channels(image, view);
  if (!found.ok()) {
    return found.failure();
  }
  const std::array<std::size_t, 3>& channels = found.value();
  DisplayedImage displayed{{image.layout().data.width(), image.layout().data.height(), 3, {}}, {}};
  const double gain = std::exp2(transform.exposure_stops);
  const std::size_t count = image.plane(channels[0]).size();
  displayed.pixels.samples.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 film{image.plane(channels[0])[i], image.plane(channels[1])[i], image.plane(channels[2])[i]};
    Vec3 shown = transform.apply(film);
    if (has_nan(shown)) {
      ++displayed.report.not_a_number;
      shown = Vec3{1.0, 0.0, 1.0};
    } else {
      displayed.report.outside_gamut += least(film) < 0.0 ? 1 : 0;
      displayed.report.beyond_white += greatest(film) * gain > 1.0 ? 1 : 0;
    }
    for (const double value : {shown.r, shown.g, shown.b}) {
      displayed.pixels.samples.push_back(to_byte(value));
    }
  }
  return displayed;
}

}  // namespace backlight
