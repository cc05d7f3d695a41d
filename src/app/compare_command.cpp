#include <algorithm>
#include <iostream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "backlight/base/files.h"
#include "commands.h"
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

// Whether --update would put the new image in the reference's place: only where that changes the verdict. A
// reference that cannot be read or has another layout is replaced too; a new image that cannot be read is not
// taken.
bool is_to_be_updated(const CompareOutcome& outcome) {
  if (!outcome.now) return false;
  return outcome.status == CompareStatus::differs || outcome.status == CompareStatus::extra ||
         outcome.status == CompareStatus::trouble;
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

// Compares one image, and takes it as the new reference where that was asked for.
CompareOutcome look_at(const ImagePair& pair, const CompareOptions& options, bool single, Totals& totals) {
  CompareOutcome outcome = compare_pair(pair, options.limits);
  const bool good = outcome.status == CompareStatus::equal;
  if (options.verbosity != Verbosity::quiet) {
    std::cout << outcome_text(outcome, !single && good && options.verbosity != Verbosity::verbose);
  }
  if (outcome.status == CompareStatus::trouble) print_error(pair.name + ": " + outcome.reason);
  ++totals.compared;
  ++totals.counts[static_cast<std::size_t>(outcome.status)];
  return outcome;
}

void take_as_reference(CompareOutcome& outcome, Totals& totals) {
  const Result<void> updated = update(outcome.pair);
  --totals.counts[static_cast<std::size_t>(outcome.status)];
  if (updated.ok()) {
    std::cout << "updated " << outcome.pair.reference_place.string() << '\n';
    outcome.status = CompareStatus::equal;
    ++totals.updated;
  } else {
    print_error(updated.error());
    outcome.status = CompareStatus::trouble;
  }
  ++totals.counts[static_cast<std::size_t>(outcome.status)];
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
  for (const ImagePair& pair : pairs.value()) {
    CompareOutcome outcome = look_at(pair, options, single, totals);
    if (const auto added = options.html.empty() ? Result<void>() : report.add(outcome); !added.ok()) {
      return trouble(pair.name + ": " + added.error());
    }
    if (options.update && is_to_be_updated(outcome)) take_as_reference(outcome, totals);
  }
  if (!options.html.empty()) {
    if (const auto written = report.write(options.html); !written.ok()) return trouble(written.error());
  }
  if (!single && options.verbosity != Verbosity::quiet) std::cout << summary(totals) << '\n';
  return exit_code(totals);
}

}  // namespace backlight
