// The largest of many errors; a NaN is the worst of all.
#pragma once

#include <cmath>
#include <limits>
#include <string>

namespace backlight::test {

struct Worst {
  double error = 0.0;
  std::string where;
  int compared = 0;

  void take(double candidate, const std::string& place = {}) {
    ++compared;
    if (std::isnan(candidate)) candidate = std::numeric_limits<double>::infinity();
    if (candidate > error) {
      error = candidate;
      where = place;
    }
  }
};

}  // namespace backlight::test
