// The few pieces of JSON that are written by hand: lines of progress and of statistics.
#pragma once

#include <string>
#include <string_view>

namespace backlight {

/// `text` as a JSON string, quotes included. Bytes that are not UTF-8 become U+FFFD.
std::string json_quoted(std::string_view text);

/// The shortest decimal that reads back as `value`; null when it is not finite, for which JSON has no number.
std::string json_number(double value);

}  // namespace backlight
