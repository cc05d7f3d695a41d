#include "backlight/trace/ray.h"

#include <algorithm>
#include <cmath>

namespace backlight {
namespace {

// Moves the ray's start in extended precision. From there on doubles are as good as near an object at rest.
void move_start(const FarView& far, const CameraRay& ray, double start, RestRayEvents& events) {
  const ExtendedEvent event = far_event(far, ray, Extended(start));
  events.start = start;
  events.time = double(event.t);
  events.origin = event.x.rounded();
}

// The ray from the camera's event on.
RestRayEvents from_camera(const FrameView& frame, const CameraRay& ray) {
  RestRayEvents events;
  events.origin = frame.camera_event.x;
  events.time = frame.camera_event.t;
  if (ray.displaced) {
    const Displacement<Rest> offset = frame.from_camera(ray.offset);
    events.origin += offset.x;
    events.time += offset.t;
  }
  events.index = ray.index;
  if (ray.light_delay && ray.index == 1.0) {
    const NullDirection<Rest> n = frame.from_camera(NullDirection<Camera>{ray.direction, ray.length});
    events.direction = n.x;
    events.time_rate = -n.length;
  } else {
    const double rate = ray.light_delay ? -ray.index * ray.length : 0.0;
    const Displacement<Rest> n = frame.from_camera(Displacement<Camera>{rate, ray.direction});
    events.direction = n.x;
    events.time_rate = n.t;
  }
  return events;
}

}  // namespace

double start_near(const BoundingSphere& bounds, const RestRayEvents& events) {
  const double inverse_square = 1.0 / glm::dot(events.direction, events.direction);
  const Vec3 to_centre = bounds.centre - events.origin;
  const double closest = glm::dot(to_centre, events.direction) * inverse_square;
  const double room = bounds.radius * 1.001 + 1e-12 * glm::length(to_centre);
  return std::max(0.0, closest - room * std::sqrt(inverse_square));
}

ExtendedEvent far_event(const FarView& far, const CameraRay& ray, const Extended& lambda) {
  const ExtendedVec3 looking{ray.direction};
  Extended rate = ray.light_delay ? -sqrt(dot(looking, looking)) : Extended(0.0);
  if (ray.index != 1.0) rate = Extended(ray.index) * rate;
  const ExtendedEvent n = far.from_camera(ExtendedEvent{rate, looking});
  ExtendedEvent event = far.camera_event;
  if (ray.displaced) {
    const ExtendedEvent offset = far.from_camera({Extended(ray.offset.t), ExtendedVec3{ray.offset.x}});
    event = {event.t + offset.t, event.x + offset.x};
  }
  return {event.t + lambda * n.t, event.x + lambda * n.x};
}

RestRayEvents in_frame(const FrameView& frame, const CameraRay& ray) {
  RestRayEvents events = from_camera(frame, ray);
  if (frame.far && frame.far->bounds.radius >= 0.0) {
    move_start(*frame.far, ray, start_near(frame.far->bounds, events), events);
  }
  return events;
}

RestRayEvents in_frame_from(const FrameView& frame, const CameraRay& ray, double start) {
  RestRayEvents events = from_camera(frame, ray);
  move_start(*frame.far, ray, start, events);
  return events;
}

}  // namespace backlight
