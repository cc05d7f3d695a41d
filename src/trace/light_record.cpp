#include "light_record.h"

#include "backlight/colour/rgb.h"
#include "backlight/trace/tracer.h"
#include "leg.h"

namespace backlight {

bool records_light(const Scene& scene) {
  return has_aov(scene, "light");
}

bool records_lamp_times(const Scene& scene) {
  return has_aov(scene, "lampTime");
}

void Tracer::add_light(const CameraRay& ray, const Effects& effects, SurfaceRecord& record,
                       std::vector<double>& times, Scratch& scratch) const {
  scratch.rays.start(in_medium(ray));
  const FirstHit hit = first_hit(hub_, scratch.rays);
  if (hit.found()) {
    const SeenPoint point = seen_point(hub_, scratch.rays, hit);
    if (records_lamp_times(*scene_)) lamp_times(shading(), point, effects, scratch, times);
    if (records_light(*scene_)) record.lamps = lamps_reaching(shading(), point, effects, scratch);
  }
  if (records_light(*scene_))
    record.unshifted = luminance(colour_along(camera_leg(ray), hit, effects, false, scratch));
}

}  // namespace backlight
