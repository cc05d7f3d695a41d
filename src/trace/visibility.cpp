#include "backlight/trace/visibility.h"

namespace backlight {

FirstHit first_hit(const Hub& hub, RayInFrames& rays) {
  FirstHit first;
  for (const int index : hub.occupied) {
    const RestRayEvents& ray = rays.in(index);
    const SurfaceSet& surfaces = hub.frames[static_cast<std::size_t>(index)].scene->surfaces;
    const Hit hit = surfaces.nearest(ray.origin, ray.direction, first.hit.lambda);
    if (hit.found()) first = {hit, index};
  }
  return first;
}

bool is_shadowed(const Hub& hub, RayInFrames& rays, const FirstHit& hit, const LightView& light,
                 const ShadowSegment& segment) {
  for (const int index : hub.occupied) {
    const SurfaceSet& surfaces = hub.frames[static_cast<std::size_t>(index)].scene->surfaces;
    if (index == hit.frame) {
      if (surfaces.blocked(segment.start_in_surface_frame, segment.direction_in_surface_frame, 0.0,
                           segment.end)) {
        return true;
      }
      continue;
    }
    const auto& to_frame = light.to_frame[static_cast<std::size_t>(index)];
    const Vec3 start = rays.in(index).at(hit.hit.lambda).x;
    if (surfaces.blocked(start, to_frame(segment.direction).x, 0.0, segment.end)) return true;
  }
  return false;
}

}  // namespace backlight
