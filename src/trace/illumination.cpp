#include "backlight/trace/illumination.h"

#include <cmath>
#include <limits>

namespace backlight {
namespace {

// The way from the hit to the light, in the light's frame, and the light's own time when it left.
struct WayToLight {
  NullDirection<Source> direction;
  double emission_time;
};

// Equation (10): the past light cone of the hit meets the lamp's world line, and there is nothing to solve in
// the lamp's frame. Of a distant light, it is the time of the wave front: below (13).
WayToLight way_from(const Event<Source>& event, const Light& light) {
  if (light.kind == LightKind::distant) {
    return {{-light.direction, 1.0}, event.t - glm::dot(light.direction, event.x)};
  }
  const NullDirection<Source> direction = null_direction<Source>(light.position - event.x);
  return {direction, event.t - direction.length};
}

// The same where the lamp is fast: the event may be γ² times farther from its frame's origin than the light
// travels there.
WayToLight way_from(const ExtendedEvent& event, const Light& light) {
  if (light.kind == LightKind::distant) {
    const Extended front = event.t - dot(ExtendedVec3{light.direction}, event.x);
    return {{-light.direction, 1.0}, double(front)};
  }
  const ExtendedVec3 way = ExtendedVec3{light.position} - event.x;
  const Extended length = sqrt(dot(way, way));
  return {{way.rounded(), double(length)}, double(event.t - length)};
}

// In the surface's own frame the refined point is the better one; in any other the event is the camera's plus
// λ n, and never a boosted position.
WayToLight way_to_light(const Hub& hub, RayInFrames& rays, const SeenPoint& point, const Light& light) {
  if (light.frame == point.hit.frame)
    return way_from(Event<Source>{point.proper_time, point.surface.position}, light);
  const FrameView& frame = hub.frames[static_cast<std::size_t>(light.frame)];
  if (frame.far) return way_from(far_event(*frame.far, rays.ray(), point.hit.lambda), light);
  const Event<Rest> event = rays.in(light.frame).at(point.hit.lambda);
  return way_from(Event<Source>{event.t, event.x}, light);  // entered through its index: Rest is Source here
}

}  // namespace

SeenPoint seen_point(const Hub& hub, RayInFrames& rays, const FirstHit& hit) {
  const RestRayEvents& ray = rays.in_frame_of(hit);
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

std::optional<Arrival> arrival(const Hub& hub, RayInFrames& rays, const SeenPoint& point,
                               const LightView& view) {
  const Light& light = *view.light;
  const WayToLight way = way_to_light(hub, rays, point, light);
  Arrival a;
  a.segment.direction = way.direction;
  a.emission_time = way.emission_time;
  if (light.kind == LightKind::distant) a.segment.end = std::numeric_limits<double>::infinity();
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
