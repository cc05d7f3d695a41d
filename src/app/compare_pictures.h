// The pictures of a report: both images, and where they differ.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "backlight/base/result.h"
#include "compare_outcome.h"

namespace backlight {

/// What the page shows for one choice of channels. The pictures are addresses that hold a PNG; empty: none.
struct ReportPicture {
  std::string label;  ///< "colour", "Z"...
  std::string reference;
  std::string now;
  std::string heat;  ///< |new - reference|, the greatest of the channels
  int width = 0;     ///< in pixels of the PNGs, which are smaller than a wide image
  int height = 0;
  double heat_max = 0.0;  ///< the brightest of the heat map; six decades below, it is black
  bool strange = false;   ///< some pixels cannot be compared
  int worst_x = -1;       ///< of the image; -1 where all values are equal
  int worst_y = -1;
};

/// The colour of each view, and every other channel that differs.
Result<std::vector<ReportPicture>> report_pictures(const CompareOutcome& outcome);

}  // namespace backlight
