#include "compare_pairs.h"

#include <map>
#include <system_error>

namespace backlight {
namespace {

namespace fs = std::filesystem;

Result<bool> is_folder(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    const auto reason = error ? error : std::make_error_code(std::errc::no_such_file_or_directory);
    return Failure{"cannot read " + path.string() + ": " + reason.message()};
  }
  return fs::is_directory(status);
}

bool is_hidden(const fs::path& path) {
  return path.filename().string().starts_with(".");
}

// The .exr files below `top`, by their paths from there.
Result<std::map<std::string, fs::path>> images_below(const fs::path& top) {
  std::map<std::string, fs::path> found;
  std::error_code error;
  fs::recursive_directory_iterator entry(top, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (is_hidden(entry->path())) {
      if (entry->is_directory()) entry.disable_recursion_pending();
      continue;
    }
    if (entry->path().extension() != ".exr" || !entry->is_regular_file()) continue;
    found[entry->path().lexically_relative(top).generic_string()] = entry->path();
  }
  if (error) return Failure{"cannot read " + top.string() + ": " + error.message()};
  return found;
}

}  // namespace

Result<std::vector<ImagePair>> pairs_of(const fs::path& reference, const fs::path& now, bool update) {
  const auto now_folder = is_folder(now);
  if (!now_folder.ok()) return now_folder.failure();
  std::error_code ignored;
  const bool is_new = update && !fs::exists(reference, ignored);
  const auto reference_folder = is_new ? now_folder : is_folder(reference);
  if (!reference_folder.ok()) return reference_folder.failure();
  if (reference_folder.value() != now_folder.value()) {
    return Failure{"a folder can only be compared with a folder: " +
                   (reference_folder.value() ? now : reference).string() + " is a file"};
  }
  std::vector<ImagePair> pairs;
  if (!now_folder.value()) {
    pairs.push_back({now.filename().string(), is_new ? fs::path() : reference, now, reference});
    return pairs;
  }
  std::map<std::string, fs::path> none;
  const auto references = is_new ? Result(none) : images_below(reference);
  if (!references.ok()) return references.failure();
  const auto images = images_below(now);
  if (!images.ok()) return images.failure();
  std::map<std::string, ImagePair> by_name;
  for (const auto& [name, path] : references.value()) by_name[name].reference = path;
  for (const auto& [name, path] : images.value()) by_name[name].now = path;
  for (auto& [name, pair] : by_name) {
    pair.name = name;
    pair.reference_place = reference / name;
    pairs.push_back(std::move(pair));
  }
  if (pairs.empty()) {
    return Failure{"there is no .exr file in " + reference.string() + " or " + now.string()};
  }
  return pairs;
}

}  // namespace backlight
