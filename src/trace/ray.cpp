#include "backlight/trace/ray.h"

#include <algorithm>
#include <cmath>

namespace backlight {
namespace {

// Moves the ray's start, in extended precision, to where it enters the bounds of the frame's surfaces (with
// room for the rounding of where that is). From there on doubles are as good as near an object at rest.
void bring_near(const FarView& far, const CameraRay& ray, RestRayEvents& events) {
  const double inverse_square = 1.0 / glm::dot(events.direction, events.direction);
  const Vec3 to_centre = far.bounds.centre - events.origin;
  const double closest = glm::dot(to_centre, events.direction) * inverse_square;
  const double room = far.bounds.radius * 1.001 + 1e-12 * glm::length(to_centre);
  events.start = std::max(0.0, closest - room * std::sqrt(inverse_square));

  const ExtendedVec3 looking{ray.direction};
  const Extended rate = ray.light_delay ? -sqrt(dot(looking, looking)) : Extended(0.0);
  const ExtendedEvent n = far.from_camera(ExtendedEvent{rate, looking});
  ExtendedEvent event = far.camera_event;
  if (ray.displaced) {
    const ExtendedEvent offset = far.from_camera({Extended(ray.offset.t), ExtendedVec3{ray.offset.x}});
    event = {event.t + offset.t, event.x + offset.x};
  }
  events.time = double(event.t + Extended(events.start) * n.t);
  events.origin = (event.x + Extended(events.start) * n.x).rounded();
}

}  // namespace

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
  if (frame.far) bring_near(*frame.far, ray, events);
  return events;
}

}  // namespace backlight
