// The verdicts of a comparison in the form of JUnit's reports, which servers that run tests read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "backlight/base/result.h"
#include "compare_outcome.h"

namespace backlight {

/// A test case for each image, or each part of one. What differs, is missing or has no reference is a
/// failure, what could not be compared an error. No times are in it: the same images give the same bytes.
class JunitReport {
 public:
  /// `updated`: the new image has become the reference, so that nothing is left to complain of.
  void add(const CompareOutcome& outcome, bool updated);

  Result<void> write(const std::filesystem::path& path) const;

 private:
  std::string cases_;
  std::size_t tests_ = 0;
  std::size_t failures_ = 0;
  std::size_t errors_ = 0;
};

}  // namespace backlight
