#include "light_record.h"

#include <algorithm>

#include "backlight/colour/rgb.h"
#include "backlight/trace/tracer.h"

namespace backlight {

bool records_light(const Scene& scene) {
  const auto& aovs = scene.film.aovs;
  return std::find(aovs.begin(), aovs.end(), "light") != aovs.end();
}

void Tracer::add_light(const CameraRay& ray, const Effects& effects, SurfaceRecord& record,
                       Scratch& scratch) const {
  scratch.rays.start(ray);
  const FirstHit hit = first_hit(hub_, scratch.rays);
  const int frame = hit.found() ? hit.frame : scene_->sky.frame;
  const RestRayEvents& events = scratch.rays.in(frame);
  const ShadingContext context = shading();
  Radiance<Rest> radiance;
  SeenPoint point;
  if (hit.found()) {
    point = seen_point(hub_, scratch.rays, hit);
    record.lamps = lamps_reaching(context, point, effects, scratch);
    radiance = shade(context, point, effects, scratch);
  } else {
    radiance = sky_radiance(scene_->sky, events);
  }
  // As Tracer::colour has it where colours are not to be shifted: equation (9).
  const double gamma = gamma_between(point, hub_.frames[static_cast<std::size_t>(frame)].from_camera);
  const DopplerFactor<Camera, Rest> doppler{events.doppler(ray.light_delay).value * point.doppler};
  record.unshifted = luminance(carry(radiance, doppler, gamma, effects.towards_camera()).rgb);
}

}  // namespace backlight
