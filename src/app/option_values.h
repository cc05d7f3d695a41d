// The values of flags: text -> value, or what is wrong with the text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "backlight/base/result.h"
#include "backlight/film/image.h"

namespace backlight {

/// "1280x720": width and height of at least 1.
Result<std::pair<int, int>> parse_size(std::string_view text);

/// "100,50,400,300": the pixels x0 <= x < x1, y0 <= y < y1 of the full image.
Result<PixelBox> parse_crop(std::string_view text);

/// "0.5,2": two finite numbers, the first below the second.
Result<std::pair<double, double>> parse_range(std::string_view text);

/// "320,180": a pixel of the full image, x and y from the top left.
Result<std::pair<int, int>> parse_pixel(std::string_view text);

/// A whole number between `least` and `most`, both included.
Result<std::int64_t> parse_whole(std::string_view text, std::int64_t least, std::int64_t most);

/// A finite number.
Result<double> parse_number(std::string_view text);

/// A number of at least 0; "inf" for none.
Result<double> parse_threshold(std::string_view text);

/// "NAME=0.01": a channel or layer, and a number of at least 0.
Result<std::pair<std::string, double>> parse_tolerance(std::string_view text);

/// Any text but an empty one.
Result<std::string> parse_text(std::string_view text);

/// "path=value", as it is.
Result<std::string> parse_override(std::string_view text);

/// The words of --aov: names of data channels, all and none.
std::vector<std::string> aov_words();

/// Names of data channels with commas between, all, or none.
Result<std::vector<std::string>> parse_aovs(std::string_view text);

/// What is wrong with a word that is none of `names`, and the nearest of them.
Failure not_one_of(const std::vector<std::string>& names, std::string_view text);

/// "a,b,c" cut at the commas; no part may be empty.
Result<std::vector<std::string>> parse_list(std::string_view text);

}  // namespace backlight
