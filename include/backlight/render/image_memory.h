// How much memory an image takes, known before it is begun.
#pragma once

#include <cstdint>
#include <string>

#include "backlight/base/memory.h"
#include "backlight/render/render.h"

namespace backlight {

/// Bytes of the pixels of the scene's image (of the crop, where there is one) while it is traced: four for
/// each of its channels, and one for each view, which says whether the pixel is done. Of an image of one
/// sample a pixel, those of some bands of rows; of others all.
std::uint64_t image_bytes(const Scene& scene, const RenderSettings& settings);

/// Bytes that the scene's surfaces take, about, with those that an outline leaves out; and its textures.
std::uint64_t surface_bytes(const Scene& scene);
std::uint64_t texture_bytes(const Scene& scene);

/// Why an image does not fit into what is left, and what to do, with numbers: crops of how many rows do fit,
/// and how much the data channels take. Empty if it fits.
std::string memory_shortage(const Scene& scene, const RenderSettings& settings, const MemoryLeft& left);

}  // namespace backlight
