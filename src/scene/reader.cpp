#include "backlight/scene/reader.h"

#include <algorithm>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "check.h"
#include "overrides.h"
#include "references.h"
#include "source_files.h"
#include "things_made_anew.h"

namespace backlight {
namespace {

void finish(ReadResult& result, Description description, SourceFiles& files,
            const std::vector<std::string>& overrides) {
  description.sha256 = files.sha256();
  if (!files.is_toml()) return;
  apply_overrides(description, overrides, result.diagnostics);
  collect_variables(description, result.diagnostics);
  const std::vector<bool> used = check_structure(description, result.diagnostics);
  check_references(description, used, result.diagnostics);
  warn_of_things_made_anew(description, result.diagnostics);
  result.diagnostics = in_file_order(result.diagnostics, description);
  result.description.emplace(std::move(description));
}

}  // namespace

ReadResult read_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  ReadResult result;
  Description description;
  description.file = path.string();
  SourceFiles files(description, result.diagnostics);
  if (!files.read(path)) {
    result.unreadable = true;
    return result;
  }
  finish(result, std::move(description), files, overrides);
  return result;
}

ReadResult read_scene_text(const std::string& text, const std::string& name,
                           const std::vector<std::string>& overrides, const std::filesystem::path& folder) {
  ReadResult result;
  Description description;
  description.file = name;
  SourceFiles files(description, result.diagnostics);
  files.take(text, name, folder);
  finish(result, std::move(description), files, overrides);
  return result;
}

Diagnostics in_file_order(const Diagnostics& diagnostics, const Description& description) {
  const auto place = [&](const Diagnostic& d) {
    const auto source = std::find(description.sources.begin(), description.sources.end(), d.span.source);
    return std::tuple(source - description.sources.begin(), d.span.line, d.span.column);
  };
  std::vector<Diagnostic> sorted = diagnostics.all();
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const Diagnostic& a, const Diagnostic& b) { return place(a) < place(b); });
  Diagnostics result;
  std::set<std::tuple<decltype(place(sorted.front())), std::string>> told;
  for (Diagnostic& d : sorted) {
    // What is read in two steps is found wrong in both.
    if (d.span.line > 0 && !told.emplace(place(d), d.message).second) continue;
    auto add = d.severity == Severity::error ? &Diagnostics::error : &Diagnostics::warning;
    (result.*add)(std::move(d.span), std::move(d.message), std::move(d.hint));
  }
  return result;
}

}  // namespace backlight
