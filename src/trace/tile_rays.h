// The rays of a tile, as sheets, and what they meet first.
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

/// The rays of `count` of work.legs, from `first` on: of one relay, with the same effects.
void make_rays(std::size_t first, std::size_t count, SheetScratch& work);

/// A bundle around those of all sheets.
Bundle around(std::span<const SheetScratch::TileSheet> sheets);

/// `who` of a ray whose hit is in work.far_hits.
inline constexpr double far_hit = -2.0;

/// The nearest hits of work.sheets, over all frames.
void find_hits(const Tracer& tracer, const SheetScene& scene, int eye, SheetScratch& work, Scratch& scratch);

/// One of a sheet's rays.
CameraRay camera_ray_of(const Scene& scene, const SheetRays& rays, int lane, int eye);

}  // namespace backlight
