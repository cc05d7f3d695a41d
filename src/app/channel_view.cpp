#include "channel_view.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "backlight/film/lettering.h"

namespace backlight {
namespace {

constexpr std::array<std::uint8_t, 3> nothing_there{70, 70, 70};
constexpr int least_width = 320;  // that a scale needs to be read

bool is_doppler(const std::string& channel) {
  return channel == "doppler.D" || channel == "mirror.D";
}

// Numbers of things, without any between two of them.
bool is_whole(const std::string& channel) {
  constexpr std::array whole{"objectId.V", "mirror.V", "light.N", "samples.N", "unresolved.V"};
  return std::ranges::find(whole, channel) != whole.end();
}

// What the numbers of a channel are.
std::string meaning_of(const std::string& channel) {
  struct Meaning {
    const char* channel;
    const char* words;
  };
  constexpr std::array meanings{
      Meaning{"Z", "Z: distance that the light travelled (scene units)"},
      Meaning{"doppler.D", "D: received frequency / sent frequency"},
      Meaning{"emissionTime.T", "emission time in the world (s)"},
      Meaning{"properTime.T", "own time of the matter at emission (s)"},
      Meaning{"light.N", "lights that reach the point"},
      Meaning{"light.Y", "luminance without any shift"},
      Meaning{"samples.N", "samples of the pixel"},
      Meaning{"objectId.V", "number of the object in the scene"},
      Meaning{"unresolved.V", "1: a root was not isolated"},
      Meaning{"mirror.Z", "distance travelled from what mirrors show (scene units)"},
      Meaning{"mirror.D", "in mirrors, D: received frequency / sent frequency"},
      Meaning{"mirror.T", "emission time in the world of what mirrors show (s)"},
      Meaning{"mirror.V", "number of the object that mirrors show"},
  };
  const auto found = std::ranges::find_if(meanings, [&](const Meaning& m) { return m.channel == channel; });
  if (found != meanings.end()) return found->words;
  if (channel.starts_with("lampTime."))
    return "own time of light " + channel.substr(9) + " when it sent its light (s)";
  if (channel.starts_with("P.")) return channel + ": point in the object's rest frame (scene units)";
  if (channel.starts_with("N.")) return channel + ": normal in the object's rest frame";
  return channel;
}

// Whether a channel tells something at a pixel: data channels are 0 where a ray meets no surface.
class Presence {
 public:
  Presence(const Image& image, std::size_t channel, std::size_t view) : image_(&image) {
    const ImageLayout& layout = image.layout();
    const std::string name = plain_name(layout.channels[channel].name, layout.views, view).value_or("");
    const auto find = [&](const char* base) {
      return image.find_channel(channel_name(base, layout.views, view));
    };
    rendered_ = find("rendered.V");
    if (name == "R" || name == "G" || name == "B" || name == "A" || name == "samples.N") return;
    if (name.starts_with("mirror.")) {
      object_ = find("mirror.V");
      distance_ = find("mirror.Z");
      return;
    }
    alpha_ = find("A");
    if (is_doppler(name)) return;  // the sky has one
    object_ = find("objectId.V");
    distance_ = find("Z");
  }

  [[nodiscard]] bool at(std::size_t pixel) const {
    const auto value = [&](int channel) { return image_->plane(static_cast<std::size_t>(channel))[pixel]; };
    if (rendered_ >= 0 && value(rendered_) == 0.0F) return false;
    if (alpha_ >= 0 && value(alpha_) == 0.0F) return false;
    if (object_ >= 0) return value(object_) != 0.0F;
    return distance_ < 0 || !std::isinf(value(distance_));
  }

 private:
  const Image* image_;
  int rendered_ = -1, alpha_ = -1, object_ = -1, distance_ = -1;
};

// Of a scale of one value.
double least_span(double value) {
  return std::max(1e-6 * std::abs(value), 1e-6);
}

std::string short_number(double value) {
  std::array<char, 32> digits{};
  const double shown = std::abs(value) < 1e-12 ? 0.0 : value;
  return {
      digits.data(),
      std::to_chars(digits.data(), digits.data() + digits.size(), shown, std::chars_format::general, 4).ptr};
}

void fill(PixelBytes& picture, int x, int y, const std::uint8_t* colour) {
  const auto at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                       static_cast<std::size_t>(x));
  std::copy_n(colour, 3, picture.samples.begin() + static_cast<std::ptrdiff_t>(at));
}

// The picture at the top left of a black one of this size.
PixelBytes enlarged(const PixelBytes& picture, int width, int height) {
  PixelBytes result{width, height, 3, {}};
  result.samples.assign(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  for (int y = 0; y < picture.height; ++y) {
    std::copy_n(picture.samples.begin() + std::ptrdiff_t{3} * y * picture.width, 3 * picture.width,
                result.samples.begin() + std::ptrdiff_t{3} * y * width);
  }
  return result;
}

// Words, a bar of the scale's colours and its marks, in the rows from `top` on.
Result<void> draw_scale(PixelBytes& picture, int top, int size, const ColourScale& scale,
                        const std::string& words) {
  const int margin = size / 2;
  const int width = picture.width - 2 * margin;
  const int bar = top + 2 * size;
  std::vector<float> ramp(static_cast<std::size_t>(width));
  for (int x = 0; x < width; ++x) ramp[static_cast<std::size_t>(x)] = float(x) / float(width - 1);
  const auto colours = false_colours(ramp, width, 1, scale.map);
  if (!colours.ok()) return colours.failure();
  for (int x = 0; x < width; ++x) {
    for (int y = 0; y < size; ++y)
      fill(picture, margin + x, bar + y, &colours.value().samples[3 * static_cast<std::size_t>(x)]);
  }
  const int words_size = fitting_size(words, width, size);
  auto written = write_text(picture, {words, margin, top + size + size / 2, TextSide::left, words_size});
  for (const double mark : marks_of(scale, std::max(2, width / (5 * size)))) {
    if (!written.ok()) return written;
    const double place = scale.place_of(mark);
    const int x = margin + static_cast<int>(std::lround(place * (width - 1)));
    constexpr std::array<std::uint8_t, 3> white{255, 255, 255};
    for (int y = 0; y < size / 3; ++y) fill(picture, x, bar + size + y, white.data());
    const TextSide side = place < 0.06 ? TextSide::left : place > 0.94 ? TextSide::right : TextSide::middle;
    const int at = side == TextSide::left ? margin : side == TextSide::right ? margin + width : x;
    written = write_text(picture, {short_number(mark), at, bar + 2 * size + size / 3, side, size * 9 / 10});
  }
  return written;
}

}  // namespace

double ColourScale::place_of(double value) const {
  const auto on_axis = [this](double v) { return logarithmic ? std::log(std::max(v, 1e-300)) : v; };
  return (on_axis(value) - on_axis(least)) / (on_axis(greatest) - on_axis(least));
}

std::vector<double> marks_of(const ColourScale& scale, int most) {
  // 1, 2, 5 times powers of ten; over many powers of ten, these alone, or every so many of them.
  if (scale.greatest - scale.least <= least_span(scale.least)) return {scale.least};
  const double ratio = scale.greatest / scale.least;
  std::vector<double> marks;
  if (scale.logarithmic && ratio > 4.0) {
    const int first = static_cast<int>(std::floor(std::log10(scale.least)));
    const int last = static_cast<int>(std::ceil(std::log10(scale.greatest)));
    const int every = std::max(1, (last - first + most - 1) / most);
    const bool between = 3 * (last - first) <= 2 * most;
    for (int power = first; power <= last; power += every) {
      for (const double digit : {1.0, 2.0, 5.0}) {
        if (digit > 1.0 && !between) continue;
        marks.push_back(digit * std::pow(10.0, power));
      }
    }
  } else {
    const double rough = std::max((scale.greatest - scale.least) / most, scale.whole ? 1.0 : 0.0);
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    const double step = rough <= power       ? power
                        : rough <= 2 * power ? 2 * power
                        : rough <= 5 * power ? 5 * power
                                             : 10 * power;
    for (double n = std::ceil(scale.least / step - 1e-9); n * step <= scale.greatest + 1e-9 * step; n += 1.0)
      marks.push_back(n * step);
  }
  std::erase_if(marks, [&](double mark) {
    return !(scale.place_of(mark) > -1e-9 && scale.place_of(mark) < 1.0 + 1e-9);
  });
  return marks;
}

Result<std::size_t> channel_meant(const ImageLayout& layout, const std::string& name, std::size_t view) {
  std::vector<std::size_t> of_layer;
  std::string known;
  for (std::size_t i = 0; i < layout.channels.size(); ++i) {
    const auto plain = plain_name(layout.channels[i].name, layout.views, view);
    if (!plain) continue;
    if (*plain == name) return i;
    known += (known.empty() ? "" : ", ") + *plain;
    if (plain->starts_with(name + ".")) of_layer.push_back(i);
  }
  if (of_layer.size() == 1) return of_layer.front();
  return Failure{(of_layer.empty() ? "the picture has no channel " : "more than one channel is ") + name +
                 "; there are " + known + (of_layer.empty() ? " (--aov adds others)" : "")};
}

void ChannelValues::add(const Image& image, std::size_t channel, std::size_t view) {
  const Presence present(image, channel, view);
  const std::span<const float> values = image.plane(channel);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]) || !present.at(i)) continue;
    const double value = double(values[i]);
    least_ = std::min(least_, value);
    greatest_ = std::max(greatest_, value);
  }
}

ColourScale ChannelValues::scale_for(const std::string& channel) const {
  if (is_doppler(channel)) {
    // As far towards the blue as towards the red, so that 1 is in the middle.
    const double farthest = empty() || !(least_ > 0.0) ? 1.0 : std::max(greatest_, 1.0 / least_);
    const double end = std::max(farthest, 1.01);
    return {1.0 / end, end, true, false, ColourMap::shift};
  }
  ColourScale scale{empty() ? 0.0 : least_, empty() ? 1.0 : greatest_};
  scale.logarithmic = channel == "Z" && scale.least > 0.0 && scale.greatest > 30.0 * scale.least;
  scale.whole = is_whole(channel);
  if (!(scale.greatest > scale.least))
    scale.greatest = scale.least + (scale.whole ? 1.0 : least_span(scale.least));
  return scale;
}

Result<PixelBytes> show_channel(const ExrPicture& picture, std::size_t channel, std::size_t view,
                                const ColourScale& scale) {
  const ImageLayout& layout = picture.image.layout();
  const int width = layout.data.width();
  const int height = layout.data.height();
  const Presence present(picture.image, channel, view);
  std::vector<float> places(picture.image.plane(channel).begin(), picture.image.plane(channel).end());
  std::vector<std::size_t> empty;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!present.at(i) || std::isinf(places[i])) empty.push_back(i);
    if (!std::isnan(places[i])) places[i] = static_cast<float>(scale.place_of(double(places[i])));
  }
  auto colours = false_colours(places, width, height, scale.map);
  if (!colours.ok()) return colours;
  for (const std::size_t i : empty)
    std::copy_n(nothing_there.begin(), 3,
                colours.value().samples.begin() + static_cast<std::ptrdiff_t>(3 * i));
  const int size = std::clamp(height / 22, 12, 28);
  PixelBytes result = enlarged(colours.value(), std::max(width, least_width), height + 5 * size);
  const std::string words =
      meaning_of(plain_name(layout.channels[channel].name, layout.views, view).value_or(""));
  if (const auto drawn = draw_scale(result, height, size, scale, words); !drawn.ok()) return drawn.failure();
  return result;
}

}  // namespace backlight
