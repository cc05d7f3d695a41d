#include "messages.h"

#include <iostream>
#include <string>

namespace backlight {
namespace {

std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

void print_error(std::string_view message) {
  std::cerr << "backlight: error: " << message << '\n';
}

void print_warning(std::string_view message) {
  std::cerr << "backlight: warning: " << message << '\n';
}

void print(const Diagnostics& diagnostics) {
  constexpr std::size_t most_shown = 100;
  std::size_t shown = 0;
  // Errors before warnings, where not all are shown.
  const bool all = diagnostics.all().size() <= most_shown;
  for (const Severity severity : {Severity::error, Severity::warning}) {
    for (const Diagnostic& diagnostic : diagnostics.all()) {
      if (all && severity == Severity::warning) break;
      if (shown == most_shown) break;
      if (!all && diagnostic.severity != severity) continue;
      std::cerr << format(diagnostic) << '\n';
      ++shown;
    }
  }
  if (!all) std::cerr << "and " << diagnostics.all().size() - shown << " more\n";
  const std::size_t errors = diagnostics.error_count();
  const std::size_t warnings = diagnostics.all().size() - errors;
  if (errors + warnings < 2) return;
  std::string summary = errors > 0 ? counted(errors, "error") : "";
  if (warnings > 0) summary += (errors > 0 ? " and " : "") + counted(warnings, "warning");
  std::cerr << summary << '\n';
}

}  // namespace backlight
