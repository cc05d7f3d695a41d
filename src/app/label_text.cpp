#include "label_text.h"

#include <charconv>
#include <iomanip>
#include <map>
#include <optional>
#include <sstream>

#include "backlight/base/diagnostics.h"

namespace backlight {
namespace {

constexpr std::string_view prefix = "backlight/";

// What may stand in braces, as the header has it.
std::map<std::string, std::string> names_of(const std::filesystem::path& file, const ExrHeader& header) {
  std::map<std::string, std::string> names{{"file", file.stem().string()}};
  for (const ExrAttribute& attribute : header.attributes) {
    if (!attribute.name.starts_with(prefix)) continue;
    const std::string name = attribute.name.substr(prefix.size());
    const auto* list = std::get_if<std::vector<std::string>>(&attribute.value);
    if (list == nullptr) names[name] = text_of(attribute.value);
    if (list == nullptr || name != "params") continue;
    for (const std::string& parameter : *list) {  // "v = 0.9"
      const std::size_t equals = parameter.find(" = ");
      if (equals != std::string::npos)
        names["params." + parameter.substr(0, equals)] = parameter.substr(equals + 3);
    }
  }
  return names;
}

// A number with so many decimals, or with 6 digits; any other text as it is.
std::string shortened(const std::string& text, std::optional<int> decimals) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return text;
  std::ostringstream out;
  if (decimals) out << std::fixed;
  out << std::setprecision(decimals.value_or(6)) << value;
  return out.str();
}

Result<std::string> filled(const std::string& braced, const std::map<std::string, std::string>& names) {
  const std::size_t colon = braced.find(':');
  const std::string name = braced.substr(0, colon);
  std::optional<int> decimals;
  if (colon != std::string::npos) {
    const std::string format = braced.substr(colon + 1);
    if (format.size() != 2 || format[0] != '.' || format[1] < '0' || format[1] > '9')
      return Failure{"'{" + braced + "}': expected decimals such as {" + name + ":.2}"};
    decimals = format[1] - '0';
  }
  if (const auto found = names.find(name); found != names.end()) return shortened(found->second, decimals);
  std::vector<std::string> known;
  std::string list;
  for (const auto& [one, value] : names) {
    known.push_back(one);
    list += (list.empty() ? "" : ", ") + one;
  }
  const std::string near = nearest_name(name, known);
  return Failure{"the image does not tell {" + name + "}" +
                 (near.empty() ? "; there are " + list : "; did you mean {" + near + "}?")};
}

}  // namespace

Result<std::string> label_text(const std::string& pattern, const std::filesystem::path& file,
                               const ExrHeader& header) {
  const auto names = names_of(file, header);
  std::string text;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const bool doubled = i + 1 < pattern.size() && pattern[i + 1] == pattern[i];
    if (doubled && (pattern[i] == '{' || pattern[i] == '}')) {
      text += pattern[i++];
    } else if (pattern[i] == '{') {
      const std::size_t close = pattern.find('}', i);
      if (close == std::string::npos) return Failure{"'" + pattern.substr(i) + "' has no closing brace"};
      auto part = filled(pattern.substr(i + 1, close - i - 1), names);
      if (!part.ok()) return part;
      text += part.value();
      i = close;
    } else {
      text += pattern[i];
    }
  }
  return text;
}

}  // namespace backlight
