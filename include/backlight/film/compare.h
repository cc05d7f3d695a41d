// How far two pictures are apart, and the verdict on it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "backlight/base/result.h"
#include "backlight/film/image.h"

namespace backlight {

/// When two pictures count as different. The rules and the defaults are those of OpenImageIO's idiff: a value
/// is over a threshold when |a - b| passes the absolute one *and* |a - b| / ((|a| + |b|) / 2) the relative
/// one; a pixel is when any of its channels is.
struct CompareLimits {
  double fail = 1e-6;                ///< absolute difference
  double fail_relative = 0.0;        ///< relative difference
  double fail_percent = 0.0;         ///< this share of the pixels, in %, may be over the threshold
  std::uint64_t allow_failures = 0;  ///< or so many pixels, by any amount
  /// No value may differ by more, `allow_failures` apart. (idiff 2.4 looks at it only where a pixel is over
  /// `fail` too.)
  double hard_fail = std::numeric_limits<double>::infinity();

  double warn = 1e-6;
  double warn_relative = 0.0;
  double warn_percent = 0.0;
  double hard_warn = std::numeric_limits<double>::infinity();

  /// Absolute thresholds of their own, instead of `fail` and `warn`, by name: of a channel ("Z", "doppler.D")
  /// in all views, or of a layer ("P"). The last one that fits counts.
  std::vector<std::pair<std::string, double>> tolerances;

  /// Only these channels are compared, named in the same way; empty: all of them.
  std::vector<std::string> channels;
};

/// One channel of the two pictures. Differences are new - reference.
///
/// A value that is not finite equals itself: NaN and NaN, or infinities of one sign, at the same pixel are no
/// difference. Any other pair with a value that is not finite is over every threshold; it counts in
/// `not_comparable` and stays out of mean, RMS and maximum.
struct ChannelDifference {
  std::string name;
  double tolerance = 0.0;  ///< absolute, of failures
  double mean = 0.0;       ///< of |new - reference|
  double rms = 0.0;
  double psnr = 0.0;     ///< 20 lg(peak / rms) dB; peak is the greatest value, at least 1; inf where equal
  double maximum = 0.0;  ///< of |new - reference|; infinite where `not_comparable` is not 0
  int x = -1;            ///< where the maximum is, pixel of the whole picture; -1 where all values are equal
  int y = -1;
  double reference = 0.0;  ///< the values there
  double now = 0.0;
  std::uint64_t over_fail = 0;  ///< values
  std::uint64_t over_warn = 0;
  std::uint64_t nan_reference = 0;
  std::uint64_t nan_new = 0;
  std::uint64_t inf_reference = 0;
  std::uint64_t inf_new = 0;
  std::uint64_t not_comparable = 0;
};

enum class Verdict { pass, warning, failure };

struct ImageDifference {
  std::vector<ChannelDifference> channels;  ///< in the reference's order
  std::uint64_t pixels = 0;
  std::uint64_t over_fail = 0;  ///< pixels
  std::uint64_t over_warn = 0;
  Verdict verdict = Verdict::pass;

  /// The channel with the greatest difference in units of its tolerance; the first one where all are equal.
  [[nodiscard]] const ChannelDifference& worst() const;
};

/// Compares channel by channel, by name: values, however they are stored (half, float, whole numbers, which
/// are compared exactly). 0 and -0 are equal, and so are all NaNs. Fails if the pictures cannot be compared:
/// other display or data windows, views, or channels on one side only; or if a name of the limits fits no
/// channel.
Result<ImageDifference> compare_images(const Image& reference, const Image& now, const CompareLimits& limits);

/// Whether `name` of a limit ("Z", "P", "right.R") means the file's channel `channel`.
bool names_channel(const std::string& name, const std::string& channel,
                   const std::vector<std::string>& views);

/// |new - reference| of one pixel by the rules of ChannelDifference: 0 for equal values, also for those that
/// are not finite, and infinite where the two cannot be compared.
double value_difference(double reference, double now);

}  // namespace backlight
