#include "backlight/trace/visibility.h"

#include <algorithm>
#include <limits>

namespace backlight {

const Object& object_of(const Scene& scene, int frame, int surface) {
  const SceneFrame& of = scene.frames[static_cast<std::size_t>(frame)];
  return scene.objects[static_cast<std::size_t>(of.object_of_surface[static_cast<std::size_t>(surface)])];
}

const Object& object_of(const Scene& scene, const FirstHit& hit) {
  return object_of(scene, hit.frame, hit.hit.surface);
}

int material_of(const Scene& scene, const FirstHit& hit, const SurfacePoint& point) {
  const Object& object = object_of(scene, hit);
  return object.member_materials.empty() ? object.material
                                         : object.member_materials[static_cast<std::size_t>(point.member)];
}

FirstHit first_hit(const Hub& hub, RayInFrames& rays) {
  FirstHit first;
  double nearest = std::numeric_limits<double>::infinity();
  for (const int index : hub.occupied) {
    const RestRayEvents& ray = rays.in(index);
    const SurfaceSet& surfaces = *hub.frames[static_cast<std::size_t>(index)].scene->surfaces;
    const Hit hit = surfaces.nearest(ray.origin, ray.direction, nearest - ray.start, ray.clock());
    if (!hit.found()) continue;
    first = {hit, index, Extended(ray.start) + Extended(hit.lambda)};
    nearest = double(first.lambda);
  }
  return first;
}

bool is_shadowed_in(int frame, const Hub& hub, RayInFrames& rays, const FirstHit& hit, const LightView& light,
                    const ShadowSegment& segment) {
  const SurfaceSet& surfaces = *hub.frames[static_cast<std::size_t>(frame)].scene->surfaces;
  if (frame == hit.frame) {
    return surfaces.blocked(segment.start_in_surface_frame, segment.direction_in_surface_frame, 0.0,
                            segment.end, segment.clock_in_surface_frame);
  }
  const Event<Rest> start = rays.in(frame).at(hit.lambda);
  if (!light.retarded_shadows) {
    const Displacement<Rest> now =
        light.to_frame[static_cast<std::size_t>(frame)](Displacement<Source>{0.0, segment.direction.x});
    return surfaces.blocked(start.x, now.x, 0.0, segment.end, {start.t, now.t});
  }
  const NullDirection<Rest> direction = light.to_frame[static_cast<std::size_t>(frame)](segment.direction);
  return surfaces.blocked(start.x, direction.x, 0.0, segment.end, {start.t, -direction.length});
}

bool is_shadowed(const Hub& hub, RayInFrames& rays, const FirstHit& hit, const LightView& light,
                 const ShadowSegment& segment) {
  return std::any_of(hub.occupied.begin(), hub.occupied.end(),
                     [&](int frame) { return is_shadowed_in(frame, hub, rays, hit, light, segment); });
}

}  // namespace backlight
