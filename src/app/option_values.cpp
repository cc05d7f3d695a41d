#include "option_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>

#include "backlight/base/diagnostics.h"
#include "backlight/scene/keys.h"

namespace backlight {
namespace {

constexpr int largest_edge = 65536;

template <class Number>
std::optional<Number> number_text(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string quoted(std::string_view text) {
  return "'" + std::string(text) + "'";
}

}  // namespace

Result<std::pair<int, int>> parse_size(std::string_view text) {
  const std::size_t cross = std::min(text.find('x'), text.size());
  const auto width = number_text<int>(text.substr(0, cross));
  const auto height = number_text<int>(text.substr(std::min(cross + 1, text.size())));
  const auto possible = [](std::optional<int> edge) { return edge && *edge >= 1 && *edge <= largest_edge; };
  if (!possible(width) || !possible(height)) {
    return Failure{"expected WIDTHxHEIGHT, such as 1280x720 (up to 65536x65536), not " + quoted(text)};
  }
  return std::pair{*width, *height};
}

Result<PixelBox> parse_crop(std::string_view text) {
  const Failure failure{"expected x0,y0,x1,y1 in pixels, such as 0,0,640,360, not " + quoted(text)};
  const auto parts = parse_list(text);
  if (!parts.ok() || parts.value().size() != 4) return failure;
  int edges[4];
  for (std::size_t i = 0; i < 4; ++i) {
    const auto edge = number_text<int>(parts.value()[i]);
    if (!edge || *edge < 0) return failure;
    edges[i] = *edge;
  }
  const PixelBox box{edges[0], edges[1], edges[2], edges[3]};
  if (box.empty())
    return Failure{"the crop " + quoted(text) + " is empty: x1 must be above x0, and y1 above y0"};
  return box;
}

Result<std::pair<double, double>> parse_range(std::string_view text) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const auto least = number_text<double>(text.substr(0, comma));
  const auto greatest = number_text<double>(text.substr(std::min(comma + 1, text.size())));
  if (!least || !greatest || !std::isfinite(*least) || !std::isfinite(*greatest) || !(*least < *greatest))
    return Failure{"expected LO,HI with LO below HI, such as 0.5,2, not " + quoted(text)};
  return std::pair{*least, *greatest};
}

Result<std::pair<int, int>> parse_pixel(std::string_view text) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const auto x = number_text<int>(text.substr(0, comma));
  const auto y = number_text<int>(text.substr(std::min(comma + 1, text.size())));
  if (!x || !y) return Failure{"expected a pixel X,Y in whole numbers, such as 320,180, not " + quoted(text)};
  return std::pair{*x, *y};
}

Result<std::int64_t> parse_whole(std::string_view text, std::int64_t least, std::int64_t most) {
  const auto value = number_text<std::int64_t>(text);
  if (!value || *value < least || *value > most) {
    return Failure{"expected a whole number from " + std::to_string(least) + " to " + std::to_string(most) +
                   ", not " + quoted(text)};
  }
  return *value;
}

Result<double> parse_number(std::string_view text) {
  const auto value = number_text<double>(text);
  if (!value || !std::isfinite(*value)) return Failure{"expected a number, not " + quoted(text)};
  return *value;
}

Result<double> parse_threshold(std::string_view text) {
  if (text == "inf") return std::numeric_limits<double>::infinity();
  const auto value = number_text<double>(text);
  if (!value || !(*value >= 0.0)) return Failure{"expected a number of at least 0, not " + quoted(text)};
  return *value;
}

Result<std::pair<std::string, double>> parse_tolerance(std::string_view text) {
  const std::size_t equals = text.rfind('=');
  if (equals == 0 || equals == std::string_view::npos) {
    return Failure{"expected channel=number, such as Z=1e-6, not " + quoted(text)};
  }
  const auto value = parse_threshold(text.substr(equals + 1));
  if (!value.ok()) return value.failure();
  return std::pair(std::string(text.substr(0, equals)), value.value());
}

Result<std::string> parse_text(std::string_view text) {
  if (text.empty()) return Failure{"expected a value, not an empty text"};
  return std::string(text);
}

Result<std::string> parse_override(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string_view::npos) {
    return Failure{"expected path=value, such as camera.fov=40, not " + quoted(text)};
  }
  return std::string(text);
}

Failure not_one_of(const std::vector<std::string>& names, std::string_view text) {
  std::string message = "expected one of ";
  for (const std::string& name : names) message += (&name == &names.front() ? "" : ", ") + name;
  message += ", not " + quoted(text);
  const std::string nearest = nearest_name(text, names);
  return {nearest.empty() ? message : message + "; did you mean " + quoted(nearest) + "?"};
}

namespace {

std::vector<std::string> aov_names() {
  const std::vector<std::string_view>& known = find_key(*find_table("film"), "aovs")->choices;
  return {known.begin(), known.end()};
}

}  // namespace

std::vector<std::string> aov_words() {
  std::vector<std::string> words = aov_names();
  words.insert(words.end(), {"all", "none"});
  return words;
}

Result<std::vector<std::string>> parse_aovs(std::string_view text) {
  const std::vector<std::string> names = aov_names();
  if (text == "all") return names;
  if (text == "none") return std::vector<std::string>{};
  auto list = parse_list(text);
  if (!list.ok()) return list;
  for (const std::string& name : list.value()) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      return not_one_of(list.value().size() == 1 ? aov_words() : names, name);
    }
  }
  return list;
}

Result<std::vector<std::string>> parse_list(std::string_view text) {
  std::vector<std::string> parts;
  std::string_view rest = text;
  while (true) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    if (comma == 0) return Failure{"expected names with commas between them, not " + quoted(text)};
    parts.emplace_back(rest.substr(0, comma));
    if (comma == rest.size()) return parts;
    rest.remove_prefix(comma + 1);
  }
}

}  // namespace backlight
