#include "backlight/render/image_identity.h"

#include "backlight/base/json_text.h"
#include "backlight/base/sha256.h"

namespace backlight {
namespace {

// `name value`, quoted: no text can look like two lines.
void add(std::string& list, const char* name, const std::string& value) {
  list += std::string(name) + ' ' + json_quoted(value) + '\n';
}

void add(std::string& list, const char* name, double value) {
  list += std::string(name) + ' ' + json_number(value) + '\n';
}

void add(std::string& list, const FilmSettings& film) {
  add(list, "width", film.width);
  add(list, "height", film.height);
  add(list, "samples", film.samples);
  add(list, "seed", film.seed);
  for (const std::string& aov : film.aovs) add(list, "aov", aov);
}

}  // namespace

std::string image_identity(const ImageOrigin& origin, const std::vector<std::string>& resource_digests,
                           const ImageFacts& facts, ColourStorage storage) {
  std::string list;
  add(list, "software", origin.software);
  add(list, "scene", origin.scene_sha256);
  for (const std::string& digest : resource_digests) add(list, "resource", digest);
  for (const std::string& text : origin.overrides) add(list, "override", text);
  add(list, "camera", facts.camera);
  add(list, "time", facts.time);
  add(list, "frame", facts.frame);
  add(list, facts.film);
  add(list, "storage", storage == ColourStorage::always_float ? "float" : "half");
  return sha256_hex(list);
}

bool is_complete_image(const std::filesystem::path& file, const std::string& identity,
                       const std::optional<PixelBox>& crop) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  const auto info = read_whole_exr_info(file);
  if (!info.ok()) return false;
  const ImageLayout& layout = info.value().layout;
  if (layout.data != crop.value_or(layout.display)) return false;
  const auto* complete = info.value().header.find<std::int32_t>("backlight/complete");
  const auto* found = info.value().header.find<std::string>(identity_attribute);
  return complete != nullptr && *complete == 1 && found != nullptr && *found == identity;
}

}  // namespace backlight
