#include "backlight/trace/illumination.h"

#include <cmath>
#include <limits>

namespace backlight {
namespace {

// The way from the hit to the light, in the light's frame, and the light's own time when it left.
struct WayToLight {
  NullDirection<Source> direction;
  double emission_time;
  LorentzTransform<Source, Source> lamp =
      {};  ///< from the light's frame to the lamp's own, if it moves there
};

// Of a lamp on a path, equation (40): h(t) = t_P - t - |x_P - c(t)| falls, since the lamp is slower than
// light: Newton's method within a bracket. Of a lamp that was as fast as light ever longer ago, as a rocket
// was, there are points that its light has not reached: no root, and no light.
WayToLight way_to_moving(const Event<Source>& event, const Light& light) {
  constexpr int most_steps = 200;
  constexpr double long_ago = 1e8;  // in ways from where it is now: farther than that h is rounding
  const MatterMotion& motion = *light.motion;
  double low = -std::numeric_limits<double>::infinity();
  double high = event.t;
  double time = event.t;
  double farthest = 0.0;
  MatterMotion::Centre lamp;
  Vec3 way{0.0};
  double length = 0.0;
  for (int i = 0; i < most_steps; ++i) {
    lamp = motion.centre(time);
    way = lamp.place - event.x;
    length = glm::length(way);
    if (i == 0) farthest = long_ago * length;
    const double late = (event.t - time) - length;
    if (late == 0.0 || length == 0.0) break;
    (late > 0.0 ? low : high) = time;
    double next = time + late / (1.0 + glm::dot(way, lamp.velocity) / length);
    const bool bracketed = std::isfinite(low);
    if (!(next > low && next < high) ||
        (!bracketed && event.t - next > 4.0 * (event.t - time) + 2.0 * length))
      next = bracketed ? 0.5 * low + 0.5 * high : event.t - 4.0 * (event.t - time) - length;
    if (next == time) break;
    if (!bracketed && event.t - next > farthest) return {{Vec3{0.0}, 0.0}, time};
    time = next;
  }
  return {{way, length}, time, boost_by<Source, Source>(lamp.velocity)};
}

// Equation (10): the past light cone of the hit meets the lamp's world line, and there is nothing to solve in
// the lamp's frame. Of a distant light, it is the time of the wave front: below (13).
WayToLight way_from(const Event<Source>& event, const Light& light) {
  if (light.kind == LightKind::distant) {
    return {{-light.direction, 1.0}, event.t - glm::dot(light.direction, event.x)};
  }
  if (light.motion) return way_to_moving(event, light);
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
  if (light.motion) return way_to_moving({double(event.t), event.x.rounded()}, light);
  const ExtendedVec3 way = ExtendedVec3{light.position} - event.x;
  const Extended length = sqrt(dot(way, way));
  return {{way.rounded(), double(length)}, double(event.t - length)};
}

// In the surface's own frame the refined point is the better one; in any other the event is the camera's plus
// λ n, and never a boosted position.
WayToLight way_to_light(const Hub& hub, RayInFrames& rays, const SeenPoint& point, const Light& light) {
  if (light.frame == point.hit.frame)
    return way_from(Event<Source>{point.time, point.surface.position}, light);
  const FrameView& frame = hub.frames[static_cast<std::size_t>(light.frame)];
  if (frame.far) return way_from(far_event(*frame.far, rays.ray(), point.hit.lambda), light);
  const Event<Rest> event = rays.in(light.frame).at(point.hit.lambda);
  return way_from(Event<Source>{event.t, event.x}, light);  // entered through its index: Rest is Source here
}

}  // namespace

namespace {

// Into the frame of the matter: equations (23) and (24).
void go_along(const RestRayEvents& ray, bool light_delay, SeenPoint& point) {
  point.proper_time = point.surface.own_time;
  point.matter = boost_by<Rest, Rest>(point.surface.velocity);
  const Vec3& w = point.matter.celerity();
  const double gamma = point.matter.gamma();
  const Vec3& g = point.surface.normal;
  point.normal = glm::normalize(g - glm::dot(g, w) / (gamma * (gamma + 1.0)) * w);
  if (light_delay) {
    const NullDirection<Rest> n = point.matter(NullDirection<Rest>{-point.to_camera, 1.0});
    point.doppler = 1.0 / n.length;
    point.to_camera = -n.x * point.doppler;
  } else {
    const Displacement<Rest> n = point.matter(Displacement<Rest>{ray.time_rate, ray.direction});
    point.to_camera = -glm::normalize(n.x);
  }
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
  point.normal = point.surface.normal;
  point.time = ray.at(hit.lambda).t;
  point.proper_time = point.time;
  if (point.surface.moves) go_along(ray, light_delay, point);
  const bool outside = glm::dot(point.normal, point.to_camera) >= 0.0;
  point.side = outside ? point.surface.normal : -point.surface.normal;
  if (!outside) point.normal = -point.normal;
  return point;
}

namespace {

// γ of a lamp on a path relative to the matter: minus the product of their four-velocities.
double gamma_of_lamp(const SeenPoint& point, const LorentzTransform<Rest, Source>& to_surface,
                     const LorentzTransform<Source, Source>& lamp) {
  const Displacement<Rest> u = to_surface(Displacement<Source>{lamp.gamma(), lamp.celerity()});
  return point.matter.gamma() * u.t - glm::dot(point.matter.celerity(), u.x);
}

}  // namespace

std::optional<Arrival> arrival(const Hub& hub, RayInFrames& rays, const SeenPoint& point,
                               const LightView& view) {
  const Light& light = *view.light;
  const WayToLight way = way_to_light(hub, rays, point, light);
  if (!(way.direction.length > 0.0)) return std::nullopt;
  Arrival a;
  a.segment.direction = way.direction;
  a.emission_time = light.motion && light.flickers
                        ? light.motion->own_time(light.motion->centre(way.emission_time).place,
                                                 way.emission_time, Mat3(1.0))
                        : way.emission_time;
  if (light.kind == LightKind::distant) a.segment.end = std::numeric_limits<double>::infinity();
  const auto& to_surface = view.to_frame[static_cast<std::size_t>(point.hit.frame)];
  const NullDirection<Rest> in_frame = to_surface(a.segment.direction);
  const NullDirection<Rest> k = point.matter(in_frame);
  if (!(k.length > 0.0)) return std::nullopt;
  const double inverse_length = 1.0 / k.length;
  a.to_light = k.x * inverse_length;
  a.cosine = glm::dot(point.normal, a.to_light);
  if (!(a.cosine > 0.0)) return std::nullopt;
  a.doppler = {k.length / way.lamp(way.direction).length};
  a.gamma = light.motion ? gamma_of_lamp(point, to_surface, way.lamp) : gamma_between(point, to_surface);
  if (light.kind == LightKind::point) a.inverse_square = inverse_length * inverse_length;
  a.segment.start_in_surface_frame = point.surface.position + point.surface.error_bound * point.side;
  a.segment.direction_in_surface_frame = in_frame.x;
  a.segment.clock_in_surface_frame = {point.time, -in_frame.length};
  if (!view.retarded_shadows) {
    const Displacement<Rest> now = to_surface(Displacement<Source>{0.0, a.segment.direction.x});
    a.segment.direction_in_surface_frame = now.x;
    a.segment.clock_in_surface_frame = {point.time, now.t};
  }
  return a;
}

}  // namespace backlight
