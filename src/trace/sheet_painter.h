// The colours of a tile, once it is known what its rays meet.
#pragma once

#include <vector>

#include "backlight/trace/sheet_tracer.h"
#include "sheet_shading.h"

namespace backlight {

/// Paints the rays of work.sheets, whose hits are known. `scene`: as seen from where they begin; `relays`: by
/// frame, those with mirrors whose rays go in sheets and are left in work.put_off.
void paint_tile(const Tracer& tracer, const SheetScene& scene, const std::vector<bool>& relays, int eye,
                TileAnswers wanted, SheetScratch& work, Scratch& scratch, TileLight& light);

}  // namespace backlight
