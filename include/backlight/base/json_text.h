// The few pieces of JSON and XML that are written by hand: lines of progress and of statistics, verdicts.
#pragma once

#include <string>
#include <string_view>

namespace backlight {

/// `text` as a JSON string, quotes included. Bytes that are not UTF-8 become U+FFFD.
std::string json_quoted(std::string_view text);

/// `text` as characters of an XML element or of a quoted attribute. Bytes that are not UTF-8, and control
/// characters, of which XML has none, become U+FFFD.
std::string xml_escaped(std::string_view text);

/// The shortest decimal that reads back as `value`; null when it is not finite, for which JSON has no number.
std::string json_number(double value);

}  // namespace backlight
