// The rays of a tile, as sheets, before they meet anything.
#pragma once

#include <span>

#include "sheet_shading.h"

namespace backlight {

/// One sample of each of some pixels, into work.sheets. The sheets' order is that of the pixels, and does not
/// change a bit.
void make_rays(const Scene& scene, const SheetKernels& kernels, std::span<const TilePixel> pixels,
               std::int64_t image_number, int sample, SheetScratch& work);

/// The rays through points of the image.
void make_rays(const Scene& scene, const SheetKernels& kernels, std::span<const ImagePoint> points,
               SheetScratch& work);

/// A bundle around those of all sheets.
Bundle around(std::span<const SheetScratch::TileSheet> sheets);

}  // namespace backlight
