#include "backlight/scene/scene.h"

#include <algorithm>

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

bool passes_on(const Scene& scene, const Object& object) {
  const auto its = [&](int material) {
    return passes_on(scene.materials[static_cast<std::size_t>(material)]);
  };
  return its(object.material) || std::ranges::any_of(object.member_materials, its);
}

bool passes_on(const Scene& scene, const SceneFrame& frame) {
  return std::ranges::any_of(frame.object_of_surface, [&](int object) {
    return passes_on(scene, scene.objects[static_cast<std::size_t>(object)]);
  });
}

bool has_own_light(const Material& material) {
  const bool reflects = material.texture || material.checker || !material.reflectance.spectrum.is_black();
  return reflects || material.specular > 0.0 || material.emission || material.in_time;
}

bool has_aov(const Scene& scene, std::string_view name) {
  return std::ranges::find(scene.film.aovs, name) != scene.film.aovs.end();
}

}  // namespace backlight
