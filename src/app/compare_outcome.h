// What came of comparing one image with its reference.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "backlight/film/compare.h"
#include "backlight/film/exr.h"
#include "compare_pairs.h"

namespace backlight {

enum class CompareStatus {
  equal,
  warning,  ///< equal, but over a warning's threshold
  differs,
  missing,  ///< there is a reference, but no new image
  extra,    ///< there is a new image, but no reference
  trouble   ///< the two cannot be compared, for `reason`
};

/// "equal", "differs"...
const char* status_name(CompareStatus status);

struct CompareOutcome {
  ImagePair pair;
  CompareStatus status = CompareStatus::trouble;
  std::string reason;
  std::optional<ExrPicture> reference;  ///< as far as they could be read
  std::optional<ExrPicture> now;
  std::optional<ImageDifference> difference;
};

/// Reads the two files and compares them: an outcome for each part, at least one. Parts are matched by name;
/// one on one side only is `missing` or `extra`. What of a part cannot be looked at is trouble: deep
/// pictures, subsampled channels, smaller levels. Parts without a channel of `limits.channels` are left out.
std::vector<CompareOutcome> compare_pair(const ImagePair& pair, const CompareLimits& limits);

/// What was found, as text with a table of the channels; one line when `brief`.
std::string outcome_text(const CompareOutcome& outcome, bool brief);

/// The command line that renders pixel (x, y) of the image again, or all of it where x < 0: from the file's
/// header. Empty if that does not say which scene it is of.
std::string render_again(const ExrPicture& picture, int x, int y, const std::filesystem::path& scenes);

}  // namespace backlight
