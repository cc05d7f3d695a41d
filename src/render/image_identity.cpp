#include "backlight/render/image_identity.h"

#include <algorithm>

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
  add(list, film.adaptive ? "most samples" : "samples", film.samples);
  add(list, "tolerance", film.tolerance);
  add(list, "wavelengths", film.wavelengths);
  add(list, "seed", film.seed);
  add(list, "exposure", film.exposure);
  std::vector<std::string> aovs = film.aovs;
  std::ranges::sort(aovs);  // a file has its channels in alphabetical order
  for (const std::string& aov : aovs) add(list, "aov", aov);
}

// Of a channel as the file names it: "R", "right.R".
bool is_colour(const std::string& name, const std::vector<std::string>& views) {
  for (const char* colour : {"R", "G", "B", "A"}) {
    for (std::size_t view = 0; view < std::max<std::size_t>(views.size(), 1); ++view) {
      if (name == channel_name(colour, views, view)) return true;
    }
  }
  return false;
}

bool is_stored_as(const std::filesystem::path& file, const ImageLayout& layout, ColourStorage storage) {
  const bool has_half = std::ranges::any_of(layout.channels, [](const ChannelInfo& channel) {
    return channel.precision == ChannelPrecision::half;
  });
  if (storage == ColourStorage::always_float || has_half) {
    return has_half == (storage != ColourStorage::always_float);
  }
  const auto picture = read_exr(file);
  if (!picture.ok()) return false;
  const Image& image = picture.value().image;
  for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
    if (!is_colour(image.layout().channels[channel].name, layout.views)) continue;
    if (!std::ranges::all_of(image.plane(channel), fits_half)) return true;
  }
  return false;
}

}  // namespace

std::string image_identity(const ImageOrigin& origin, const std::vector<std::string>& resource_digests,
                           const ImageFacts& facts) {
  std::string list;
  add(list, "software", origin.software);
  add(list, "scene", origin.scene_sha256);
  for (const std::string& digest : resource_digests) add(list, "resource", digest);
  for (const std::string& text : origin.overrides) add(list, "override", text);
  add(list, "camera", facts.camera);
  add(list, "time", facts.time);
  add(list, "frame", facts.frame);
  add(list, facts.film);
  return sha256_hex(list);
}

bool is_complete_image(const std::filesystem::path& file, const std::string& identity,
                       const std::optional<PixelBox>& crop, ColourStorage storage) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  const auto info = read_whole_exr_info(file);
  if (!info.ok()) return false;
  const ImageLayout& layout = info.value().layout;
  if (layout.data != crop.value_or(layout.display)) return false;
  const auto* complete = info.value().header.find<std::int32_t>("backlight/complete");
  const auto* found = info.value().header.find<std::string>(identity_attribute);
  return complete != nullptr && *complete == 1 && found != nullptr && *found == identity &&
         is_stored_as(file, layout, storage);
}

}  // namespace backlight
