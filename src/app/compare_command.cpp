#include <algorithm>
#include <iostream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "backlight/base/files.h"
#include "commands.h"
#include "compare_junit.h"
#include "compare_outcome.h"
#include "compare_report.h"
#include "exit_codes.h"
#include "messages.h"

namespace backlight {
namespace {

struct Totals {
  std::size_t compared = 0;
  std::size_t counts[6] = {};  // by CompareStatus
  std::size_t updated = 0;

  [[nodiscard]] std::size_t of(CompareStatus status) const {
    return counts[static_cast<std::size_t>(status)];
  }
};

// What came of a file, which may have several parts.
CompareStatus status_of(const std::vector<CompareOutcome>& parts) {
  if (parts.size() == 1) return parts.front().status;
  const auto any = [&parts](CompareStatus status) {
    return std::ranges::any_of(parts, [status](const CompareOutcome& part) { return part.status == status; });
  };
  if (any(CompareStatus::trouble)) return CompareStatus::trouble;
  if (any(CompareStatus::differs) || any(CompareStatus::missing) || any(CompareStatus::extra)) {
    return CompareStatus::differs;
  }
  return any(CompareStatus::warning) ? CompareStatus::warning : CompareStatus::equal;
}

// Whether --update would put the new image in the reference's place: only where that changes the verdict. A
// reference that cannot be read or has another layout is replaced too; a new image that cannot be read is not
// taken.
bool is_to_be_updated(const std::vector<CompareOutcome>& parts) {
  const auto is_readable = [](const CompareOutcome& part) {
    return part.now || part.status == CompareStatus::missing;
  };
  if (parts.front().pair.now.empty() || !std::ranges::all_of(parts, is_readable)) return false;
  const CompareStatus status = status_of(parts);
  return status == CompareStatus::differs || status == CompareStatus::extra ||
         status == CompareStatus::trouble;
}

Result<void> update(const ImagePair& pair) {
  const auto bytes = read_file(pair.now, std::numeric_limits<std::size_t>::max());
  if (!bytes.ok()) return bytes.failure();
  return write_file(pair.reference_place, bytes.value());
}

// A sum for several images, in the order of the statuses.
std::string summary(const Totals& totals) {
  std::string text = std::to_string(totals.compared) + (totals.compared == 1 ? " image" : " images");
  for (std::size_t i = 0; i < std::size(totals.counts); ++i) {
    if (totals.counts[i] == 0) continue;
    text += ", " + std::to_string(totals.counts[i]) + " " + status_name(static_cast<CompareStatus>(i));
  }
  if (totals.updated > 0) text += ", " + std::to_string(totals.updated) + " updated";
  return text;
}

int exit_code(const Totals& totals) {
  if (totals.of(CompareStatus::trouble) > 0) return exit_compare_trouble;
  const std::size_t different =
      totals.of(CompareStatus::differs) + totals.of(CompareStatus::missing) + totals.of(CompareStatus::extra);
  return different > 0 ? exit_compare_differs : exit_success;
}

// Compares one image.
std::vector<CompareOutcome> look_at(const ImagePair& pair, const CompareOptions& options, bool single) {
  std::vector<CompareOutcome> parts = compare_pair(pair, options.limits);
  for (const CompareOutcome& part : parts) {
    const bool good = part.status == CompareStatus::equal;
    if (options.verbosity != Verbosity::quiet) {
      std::cout << outcome_text(part, !single && good && options.verbosity != Verbosity::verbose);
    }
    if (part.status == CompareStatus::trouble) print_error(part.pair.name + ": " + part.reason);
  }
  return parts;
}

// Puts the new image in the reference's place.
CompareStatus take_as_reference(const ImagePair& pair, Totals& totals) {
  const Result<void> updated = update(pair);
  if (!updated.ok()) {
    print_error(updated.error());
    return CompareStatus::trouble;
  }
  std::cout << "updated " << pair.reference_place.string() << '\n';
  ++totals.updated;
  return CompareStatus::equal;
}

int trouble(const std::string& message) {
  print_error(message);
  return exit_compare_trouble;
}

}  // namespace

int run(const CompareOptions& options) {
  const auto pairs = pairs_of(options.reference, options.now, options.update);
  if (!pairs.ok()) return trouble(pairs.error());
  const bool single = pairs.value().size() == 1;
  Totals totals;
  CompareReport report(options);
  JunitReport junit;
  for (const ImagePair& pair : pairs.value()) {
    const std::vector<CompareOutcome> parts = look_at(pair, options, single);
    for (const CompareOutcome& part : options.html.empty() ? std::vector<CompareOutcome>() : parts) {
      if (const auto added = report.add(part); !added.ok()) return trouble(pair.name + ": " + added.error());
    }
    const bool taken = options.update && is_to_be_updated(parts);
    for (const CompareOutcome& part : parts) junit.add(part, taken);
    const CompareStatus status = taken ? take_as_reference(pair, totals) : status_of(parts);
    ++totals.compared;
    ++totals.counts[static_cast<std::size_t>(status)];
  }
  if (!options.html.empty()) {
    if (const auto written = report.write(options.html); !written.ok()) return trouble(written.error());
  }
  if (!options.junit.empty()) {
    if (const auto written = junit.write(options.junit); !written.ok()) return trouble(written.error());
  }
  if (!single && options.verbosity != Verbosity::quiet) std::cout << summary(totals) << '\n';
  return exit_code(totals);
}

}  // namespace backlight
