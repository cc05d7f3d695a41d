#include "backlight/film/compare.h"

#include <algorithm>
#include <cmath>

namespace backlight {
namespace {

std::string window_text(const PixelBox& box) {
  return std::to_string(box.width()) + "x" + std::to_string(box.height()) + " at " + std::to_string(box.x0) +
         "," + std::to_string(box.y0);
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

std::vector<std::string> channel_names(const Image& image) {
  std::vector<std::string> names;
  for (const ChannelInfo& channel : image.layout().channels) names.push_back(channel.name);
  return names;
}

bool any_names(const std::vector<std::string>& wanted, const std::string& channel,
               const std::vector<std::string>& views) {
  return std::any_of(wanted.begin(), wanted.end(),
                     [&](const std::string& name) { return names_channel(name, channel, views); });
}

// The channels of `image` that are to be compared.
std::vector<std::string> wanted_channels(const Image& image, const CompareLimits& limits) {
  std::vector<std::string> names = channel_names(image);
  if (limits.channels.empty()) return names;
  std::erase_if(names, [&](const std::string& name) {
    return !any_names(limits.channels, name, image.layout().views);
  });
  return names;
}

Result<void> check_names(const Image& reference, const CompareLimits& limits) {
  std::vector<std::string> names = limits.channels;
  for (const auto& [name, tolerance] : limits.tolerances) names.push_back(name);
  const std::vector<std::string> present = channel_names(reference);
  for (const std::string& name : names) {
    const bool fits = std::any_of(present.begin(), present.end(), [&](const std::string& channel) {
      return names_channel(name, channel, reference.layout().views);
    });
    if (!fits) return Failure{"there is no channel '" + name + "'; there are " + listed(present)};
  }
  return {};
}

Result<void> check_layouts(const Image& reference, const Image& now, const CompareLimits& limits) {
  const ImageLayout& a = reference.layout();
  const ImageLayout& b = now.layout();
  if (a.display.width() != b.display.width() || a.display.height() != b.display.height()) {
    return Failure{"the sizes differ: " + std::to_string(a.display.width()) + "x" +
                   std::to_string(a.display.height()) + " and " + std::to_string(b.display.width()) + "x" +
                   std::to_string(b.display.height())};
  }
  if (a.display != b.display) {
    return Failure{"the display windows differ: " + window_text(a.display) + " and " +
                   window_text(b.display)};
  }
  if (a.data != b.data) {
    return Failure{"the data windows differ: " + window_text(a.data) + " and " + window_text(b.data)};
  }
  if (a.views != b.views) {
    return Failure{"the views differ: " + listed(a.views) + " and " + listed(b.views)};
  }
  const std::vector<std::string> wanted = wanted_channels(reference, limits);
  const std::vector<std::string> found = wanted_channels(now, limits);
  const auto without = [](std::vector<std::string> names, const std::vector<std::string>& others) {
    std::erase_if(names, [&](const std::string& name) {
      return std::find(others.begin(), others.end(), name) != others.end();
    });
    return names;
  };
  const auto missing = without(wanted, found);
  const auto extra = without(found, wanted);
  if (!missing.empty() || !extra.empty()) {
    return Failure{
        "the channels differ: " + (missing.empty() ? "" : "only in the reference: " + listed(missing)) +
        (missing.empty() || extra.empty() ? "" : "; ") +
        (extra.empty() ? "" : "only in the new picture: " + listed(extra))};
  }
  return check_names(reference, limits);
}

double relative(double difference, double a, double b) {
  const double mean = 0.5 * (std::abs(a) + std::abs(b));
  return mean > 0.0 ? difference / mean : 0.0;
}

// One channel, while its pixels are gone through.
class ChannelComparison {
 public:
  ChannelComparison(const CompareLimits& limits, std::string name, const std::vector<std::string>& views)
      : limits_(limits), fail_(limits.fail), warn_(limits.warn) {
    for (const auto& [of, tolerance] : limits.tolerances) {
      if (names_channel(of, name, views)) fail_ = warn_ = tolerance;
    }
    result_.name = std::move(name);
    result_.tolerance = fail_;
  }

  struct Over {
    bool fail;
    bool warn;
  };

  Over add(double reference, double now, int x, int y) {
    count(reference, result_.nan_reference, result_.inf_reference);
    count(now, result_.nan_new, result_.inf_new);
    const double difference = value_difference(reference, now);
    if (difference > result_.maximum) {
      result_.maximum = difference;
      result_.x = x;
      result_.y = y;
      result_.reference = reference;
      result_.now = now;
    }
    if (std::isinf(difference)) {
      ++result_.not_comparable;
      ++result_.over_fail;
      ++result_.over_warn;
      return {true, true};
    }
    sum_ += difference;
    squares_ += difference * difference;
    if (std::isfinite(reference)) {
      peak_ = std::max({peak_, std::abs(reference), std::abs(now)});
    }
    const double share = relative(difference, reference, now);
    const Over over{difference > fail_ && share > limits_.fail_relative,
                    difference > warn_ && share > limits_.warn_relative};
    result_.over_fail += over.fail ? 1U : 0U;
    result_.over_warn += over.warn ? 1U : 0U;
    return over;
  }

  ChannelDifference finish(std::uint64_t pixels) {
    const double compared = double(pixels - result_.not_comparable);
    if (compared > 0.0) {
      result_.mean = sum_ / compared;
      result_.rms = std::sqrt(squares_ / compared);
    }
    result_.psnr = 20.0 * std::log10(peak_ / result_.rms);
    return std::move(result_);
  }

 private:
  static void count(double value, std::uint64_t& nans, std::uint64_t& infinities) {
    nans += std::isnan(value) ? 1U : 0U;
    infinities += std::isinf(value) ? 1U : 0U;
  }

  const CompareLimits& limits_;
  double fail_;
  double warn_;
  double sum_ = 0.0;
  double squares_ = 0.0;
  double peak_ = 1.0;
  ChannelDifference result_;
};

// A channel's values as they are in the file: those of whole numbers need more digits than a float has.
class ExactChannel {
 public:
  ExactChannel(const Image& image, const std::string& name)
      : ExactChannel(image, static_cast<std::size_t>(image.find_channel(name))) {}

  double operator[](std::size_t i) const { return whole_.empty() ? double(plane_[i]) : double(whole_[i]); }

 private:
  ExactChannel(const Image& image, std::size_t channel)
      : plane_(image.plane(channel)), whole_(image.whole_numbers(channel)) {}

  std::span<const float> plane_;
  std::span<const std::uint32_t> whole_;
};

Verdict verdict_of(const ImageDifference& difference, const CompareLimits& limits) {
  double maximum = 0.0;
  for (const ChannelDifference& channel : difference.channels) maximum = std::max(maximum, channel.maximum);
  const auto allowed = [&](double percent) { return percent / 100.0 * double(difference.pixels); };
  const double failures = double(difference.over_fail);
  const double spared = double(limits.allow_failures);
  if ((failures > allowed(limits.fail_percent) && failures > spared) ||
      (maximum > limits.hard_fail && std::max(failures, 1.0) > spared)) {
    return Verdict::failure;
  }
  const bool warned =
      double(difference.over_warn) > allowed(limits.warn_percent) || maximum > limits.hard_warn;
  return warned ? Verdict::warning : Verdict::pass;
}

}  // namespace

const ChannelDifference& ImageDifference::worst() const {
  const auto in_tolerances = [](const ChannelDifference& channel) {
    return channel.maximum / std::max(channel.tolerance, 1e-30);
  };
  return *std::max_element(channels.begin(), channels.end(),
                           [&](const ChannelDifference& a, const ChannelDifference& b) {
                             return in_tolerances(a) < in_tolerances(b);
                           });
}

bool names_channel(const std::string& name, const std::string& channel,
                   const std::vector<std::string>& views) {
  if (name == channel || channel.starts_with(name + ".")) return true;
  for (std::size_t view = 0; view < views.size(); ++view) {
    if (channel_name(name, views, view) == channel) return true;
  }
  return false;
}

double value_difference(double reference, double now) {
  if (std::isnan(reference) && std::isnan(now)) return 0.0;
  if (reference == now) return 0.0;
  if (!std::isfinite(reference) || !std::isfinite(now)) return std::numeric_limits<double>::infinity();
  return std::abs(now - reference);
}

Result<ImageDifference> compare_images(const Image& reference, const Image& now,
                                       const CompareLimits& limits) {
  if (const auto checked = check_layouts(reference, now, limits); !checked.ok()) return checked.failure();
  const PixelBox& data = reference.layout().data;
  ImageDifference difference;
  difference.pixels = std::uint64_t(data.width()) * std::uint64_t(data.height());
  std::vector<std::uint8_t> over(difference.pixels, 0);  // bit 0: fail, bit 1: warn
  for (const std::string& name : wanted_channels(reference, limits)) {
    const ExactChannel a(reference, name);
    const ExactChannel b(now, name);
    ChannelComparison channel(limits, name, reference.layout().views);
    std::size_t i = 0;
    for (int y = data.y0; y < data.y1; ++y) {
      for (int x = data.x0; x < data.x1; ++x, ++i) {
        const auto found = channel.add(a[i], b[i], x, y);
        if (found.fail) over[i] |= 1U;
        if (found.warn) over[i] |= 2U;
      }
    }
    difference.channels.push_back(channel.finish(difference.pixels));
  }
  for (const std::uint8_t bits : over) {
    difference.over_fail += bits & 1U;
    difference.over_warn += bits >> 1U;
  }
  difference.verdict = verdict_of(difference, limits);
  return difference;
}

}  // namespace backlight
