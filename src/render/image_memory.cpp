#include "backlight/render/image_memory.h"

#include <algorithm>
#include <set>

#include "channels.h"

namespace backlight {
namespace {

// What tracing and writing take besides the pixels: threads' stacks and sheets, rows being compressed.
constexpr std::uint64_t besides = std::uint64_t{32} << 20U;

PixelBox window_of(const Scene& scene, const RenderSettings& settings) {
  return settings.crop.value_or(PixelBox{0, 0, scene.film.width, scene.film.height});
}

std::uint64_t bytes_of_pixel(const Scene& scene) {
  const ImageLayout layout = layout_of(scene, {0, 0, 1, 1});
  return 4 * layout.channels.size() + std::max<std::size_t>(layout.views.size(), 1);
}

}  // namespace

std::uint64_t image_bytes(const Scene& scene, const RenderSettings& settings) {
  const PixelBox window = window_of(scene, settings);
  // Each thread may be in a band of its own, or compress one; two wait for a helper that is at another.
  const std::int64_t bands = std::int64_t{settings.threads} + 4;
  const std::int64_t rows =
      keeps_rows(scene) ? window.height() : std::min<std::int64_t>(window.height(), bands * band_rows(scene));
  return bytes_of_pixel(scene) * static_cast<std::uint64_t>(window.width()) *
         static_cast<std::uint64_t>(rows);
}

std::uint64_t surface_bytes(const Scene& scene) {
  std::uint64_t surfaces = 0;
  for (const SceneFrame& frame : scene.frames) surfaces += frame.surface_count();
  return surfaces * bytes_of_surface;
}

std::uint64_t texture_bytes(const Scene& scene) {
  std::set<const Texture*> textures{scene.sky.texture.get()};
  for (const Material& material : scene.materials) textures.insert(material.texture.get());
  std::uint64_t bytes = 0;
  for (const Texture* texture : textures) {
    if (texture == nullptr) continue;
    bytes += std::uint64_t{12} * static_cast<std::uint64_t>(texture->width()) *
             static_cast<std::uint64_t>(texture->height());
  }
  return bytes;
}

std::string memory_shortage(const Scene& scene, const RenderSettings& settings, const MemoryLeft& left) {
  const std::uint64_t needed = image_bytes(scene, settings);
  if (needed + besides <= left.bytes) return {};
  const PixelBox window = window_of(scene, settings);
  const std::uint64_t of_pixel = bytes_of_pixel(scene);
  std::string text = "an image of " + std::to_string(window.width()) + "x" + std::to_string(window.height()) +
                     " pixels with " + std::to_string(layout_of(scene, window).channels.size()) +
                     " channels takes " + memory_words(needed) + " of memory, and " +
                     memory_words(left.bytes) + " are " + left.where;
  const std::uint64_t of_row = of_pixel * static_cast<std::uint64_t>(window.width());
  const std::uint64_t rows = left.bytes > besides ? (left.bytes - besides) / 10 * 9 / of_row : 0;
  if (rows > 0) {
    const std::uint64_t parts = (static_cast<std::uint64_t>(window.height()) + rows - 1) / rows;
    text += "\n  render it in " + std::to_string(parts) + " parts of at most " + std::to_string(rows) +
            " rows, as in --crop " + std::to_string(window.x0) + "," + std::to_string(window.y0) + "," +
            std::to_string(window.x1) + "," + std::to_string(window.y0 + static_cast<int>(rows)) +
            ", and put them together with backlight assemble";
  } else {
    text += "\n  not even one row of it fits: render it smaller with -r";
  }
  if (!scene.film.aovs.empty()) {
    Scene without;
    without.film = scene.film;
    without.film.aovs.clear();
    without.camera.stereo = scene.camera.stereo;
    text += "\n  without data channels (--aov none) it takes " + memory_words(image_bytes(without, settings));
  }
  return text;
}

}  // namespace backlight
