#include "backlight/trace/ray.h"

namespace backlight {

RestRayEvents in_frame(const FrameView& frame, const CameraRay& ray) {
  RestRayEvents events;
  events.origin = frame.camera_event.x;
  events.time = frame.camera_event.t;
  if (ray.displaced) {
    const Displacement<Rest> offset = frame.from_camera(ray.offset);
    events.origin += offset.x;
    events.time += offset.t;
  }
  if (ray.light_delay) {
    const NullDirection<Rest> n = frame.from_camera(NullDirection<Camera>{ray.direction, 1.0});
    events.direction = n.x;
    events.time_rate = -n.length;
  } else {
    const Displacement<Rest> n = frame.from_camera(Displacement<Camera>{0.0, ray.direction});
    events.direction = n.x;
    events.time_rate = n.t;
  }
  return events;
}

}  // namespace backlight
