// The report of a comparison: one HTML page with everything in it.
#pragma once

#include <filesystem>
#include <string>

#include "backlight/base/result.h"
#include "compare_outcome.h"
#include "options.h"

namespace backlight {

/// Grows image by image; of each it keeps small PNGs and numbers as text, not the pixels.
class CompareReport {
 public:
  /// The page shows these paths and thresholds.
  explicit CompareReport(const CompareOptions& options);

  /// Fails if a picture cannot be encoded.
  Result<void> add(const CompareOutcome& outcome);

  Result<void> write(const std::filesystem::path& path) const;

 private:
  std::filesystem::path scenes_;
  std::string head_;    // the members of the page's data before its images
  std::string images_;  // JSON objects with commas between
};

}  // namespace backlight
