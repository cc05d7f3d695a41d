#include "display_words.h"

#include <iomanip>
#include <sstream>

namespace backlight {

std::string words_of(const DisplayTransform& transform) {
  if (transform.tone == ToneCurve::none && transform.exposure_stops == 0.0) return {};
  constexpr const char* names[] = {"none", "reinhard", "log", "drago"};
  std::ostringstream text;
  text << "shown with --tone " << names[static_cast<std::size_t>(transform.tone)] << " --exposure "
       << std::setprecision(6) << transform.exposure_stops;
  if (transform.tone != ToneCurve::none) text << " --white " << transform.white;
  return text.str();
}

std::vector<std::string> lines_of(const DisplayReport& report) {
  std::vector<std::string> lines;
  const auto tell = [&lines](std::size_t pixels, const std::string& what) {
    if (pixels == 0) return;
    lines.push_back(std::to_string(pixels) + (pixels == 1 ? " pixel " : " pixels ") + what);
  };
  tell(report.beyond_white, "beyond white");
  tell(report.outside_gamut, "outside the screen's colours");
  tell(report.not_a_number, "not a number, shown magenta");
  return lines;
}

}  // namespace backlight
