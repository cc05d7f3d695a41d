#include "backlight/trace/illumination.h"

#include <cmath>
#include <limits>

namespace backlight {
namespace {

// The hit event in the light's frame. In the surface's own frame the refined point is the better one; in any
// other the event is the camera's plus λ n, and never a boosted position.
Event<Source> event_at_light(RayInFrames& rays, const SeenPoint& point, const LightView& light) {
  if (light.light->frame == point.hit.frame) return {point.proper_time, point.surface.position};
  const Event<Rest> event = rays.in(light.light->frame).at(point.hit.lambda);
  return {event.t, event.x};  // the light's rest frame entered through its index: Rest is Source here
}

}  // namespace

SeenPoint seen_point(const Hub& hub, RayInFrames& rays, const FirstHit& hit) {
  const RestRayEvents& ray = rays.in(hit.frame);
  SeenPoint point;
  point.hit = hit;
  point.surface = hub.frames[static_cast<std::size_t>(hit.frame)].scene->surfaces->resolve(
      hit.hit, ray.origin, ray.direction, ray.clock());
  // The boost knows the length of a null vector, 1/D; without light delay there is none.
  const bool light_delay = rays.ray().light_delay;
  const double inverse_length = light_delay ? ray.doppler(true).value : 1.0 / glm::length(ray.direction);
  point.to_camera = -ray.direction * inverse_length;
  const bool outside = glm::dot(point.surface.normal, point.to_camera) >= 0.0;
  point.normal = outside ? point.surface.normal : -point.surface.normal;
  point.proper_time = ray.at(hit.lambda).t;
  return point;
}

std::optional<Arrival> arrival(RayInFrames& rays, const SeenPoint& point, const LightView& view) {
  const Light& light = *view.light;
  const Event<Source> event = event_at_light(rays, point, view);
  Arrival a;
  if (light.kind == LightKind::distant) {
    a.segment.direction = {-light.direction, 1.0};
    a.segment.end = std::numeric_limits<double>::infinity();
    a.emission_time = event.t - glm::dot(light.direction, event.x);  // of the wave front: below (13)
  } else {
    // Equation (10): the past light cone of the hit meets the lamp's world line. Nothing to solve in its
    // frame.
    a.segment.direction = null_direction<Source>(light.position - event.x);
    a.emission_time = event.t - a.segment.direction.length;
  }
  const auto& to_surface = view.to_frame[static_cast<std::size_t>(point.hit.frame)];
  const NullDirection<Rest> k = to_surface(a.segment.direction);
  if (!(k.length > 0.0)) return std::nullopt;
  const double inverse_length = 1.0 / k.length;
  a.to_light = k.x * inverse_length;
  a.cosine = glm::dot(point.normal, a.to_light);
  if (!(a.cosine > 0.0)) return std::nullopt;
  a.doppler = {k.length / a.segment.direction.length};
  a.gamma = to_surface.gamma();
  if (light.kind == LightKind::point) a.inverse_square = inverse_length * inverse_length;
  a.segment.start_in_surface_frame = point.surface.position + point.surface.error_bound * point.normal;
  a.segment.direction_in_surface_frame = k.x;
  a.segment.clock_in_surface_frame = {point.proper_time, -k.length};
  if (!view.retarded_shadows) {
    const Displacement<Rest> now = to_surface(Displacement<Source>{0.0, a.segment.direction.x});
    a.segment.direction_in_surface_frame = now.x;
    a.segment.clock_in_surface_frame = {point.proper_time, now.t};
  }
  return a;
}

}  // namespace backlight
