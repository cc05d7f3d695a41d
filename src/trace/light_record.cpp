#include "light_record.h"

#include "backlight/colour/rgb.h"
#include "backlight/trace/tracer.h"
#include "leg.h"

namespace backlight {

bool records_light(const Scene& scene) {
  return has_aov(scene, "light");
}

void Tracer::add_light(const CameraRay& ray, const Effects& effects, SurfaceRecord& record,
                       Scratch& scratch) const {
  scratch.rays.start(in_medium(ray));
  const FirstHit hit = first_hit(hub_, scratch.rays);
  if (hit.found()) {
    const SeenPoint point = seen_point(hub_, scratch.rays, hit);
    record.lamps = lamps_reaching(shading(), point, effects, scratch);
  }
  record.unshifted = luminance(colour_along(camera_leg(ray), hit, effects, false, scratch));
}

}  // namespace backlight
