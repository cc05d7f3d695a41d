#include "backlight/scene/scene.h"

namespace backlight {

const Effects& effects_at(const Scene& scene, const ImagePoint& point) {
  const double x = point.x / scene.camera.lens.width;
  const double y = point.y / scene.camera.lens.height;
  const Effects* found = &scene.effects;
  for (const EffectsRegion& region : scene.regions) {
    if (x >= region.x0 && x < region.x1 && y >= region.y0 && y < region.y1) found = &region.effects;
  }
  return *found;
}

}  // namespace backlight
