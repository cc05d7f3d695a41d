#include "backlight/trace/illumination.h"

#include <cmath>
#include <limits>

#include "matter_normal.h"

namespace backlight {

LampMoment way_to_moving(const Light& light, const Vec3& place, double event_time) {
  constexpr int most_steps = 200;
  constexpr double long_ago = 1e8;  // in ways from where it is at the event: longer ago, h is rounding
  const MatterMotion& motion = *light.motion;
  double low = -std::numeric_limits<double>::infinity();
  double high = event_time;
  double farthest = 0.0;
  LampMoment moment;
  moment.time = event_time;
  for (int i = 0; i < most_steps; ++i) {
    const MatterMotion::Centre lamp = motion.centre(moment.time);
    const Vec3 way = lamp.place - place;
    moment.direction = {way, glm::length(way)};
    moment.velocity = lamp.velocity;
    const double length = moment.direction.length;
    if (i == 0) farthest = long_ago * length;
    const double ago = event_time - moment.time;
    const double late = ago - length;
    if (late == 0.0 || length == 0.0) break;
    (late > 0.0 ? low : high) = moment.time;
    double next = moment.time + late / (1.0 + glm::dot(way, lamp.velocity) / length);
    if (std::isfinite(low)) {
      if (!(next > low && next < high)) next = 0.5 * low + 0.5 * high;
    } else {
      const double earliest = moment.time - 3.0 * ago - 2.0 * length;
      if (!(next >= earliest && next < high)) next = earliest;
      if (event_time - next > farthest) return {{Vec3{0.0}, 0.0}, event_time};
    }
    if (next == moment.time) break;
    moment.time = next;
  }
  return moment;
}

double LampMoment::own_length() const {
  return boost_by<Source, Source>(velocity)(direction).length;
}

Vec3 LampMoment::leaving() const {
  return -boost_by<Source, Source>(velocity)(direction).x;
}

double LampMoment::strength_time(const Light& light) const {
  if (!light.has_clock()) return time;
  return light.motion->own_time(light.motion->centre(time).place, time, Mat3(1.0));
}

namespace {

// The way from the hit to the light, in the light's frame, and the light's own time when it left.
struct WayToLight {
  NullDirection<Source> direction;
  double emission_time;
  Vec3 velocity{0.0};  ///< of a lamp on a path
};

WayToLight way_of(const LampMoment& moment, const Light& light) {
  return {moment.direction, moment.strength_time(light), moment.velocity};
}

// Equation (10): the past light cone of the hit meets the lamp's world line, and there is nothing to solve in
// the lamp's frame. Of a distant light, it is the time of the wave front: below (13).
WayToLight way_from(const Event<Source>& event, const Light& light) {
  if (light.kind == LightKind::distant) {
    return {{-light.direction, 1.0}, event.t - glm::dot(light.direction, event.x)};
  }
  if (light.motion) return way_of(way_to_moving(light, event.x, event.t), light);
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
  if (light.motion) return way_of(way_to_moving(light, event.x.rounded(), double(event.t)), light);
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
  point.normal = normal_of_matter(point.matter, point.surface.normal);
  if (light_delay) {
    const NullDirection<Rest> n = point.matter(NullDirection<Rest>{-point.to_camera, 1.0});
    point.doppler = 1.0 / n.length;
    point.to_camera = -n.x * point.doppler;
  } else {
    const Displacement<Rest> n = point.matter(Displacement<Rest>{ray.time_rate, ray.direction});
    point.to_camera = (1.0 / std::sqrt(glm::dot(n.x, n.x))) * -n.x;
  }
}

}  // namespace

SeenPoint seen_point(const Hub& hub, RayInFrames& rays, const FirstHit& hit) {
  const RestRayEvents& ray = rays.in_frame_of(hit);
  SeenPoint point;
  point.hit = hit;
  const SurfaceSet& surfaces = *hub.frames[static_cast<std::size_t>(hit.frame)].scene->surfaces;
  point.surface = surfaces.resolve(hit.hit, ray.origin, ray.direction, ray.clock());
  // The boost knows the length of a null vector, 1/D; without light delay there is none.
  const bool light_delay = rays.ray().light_delay;
  const double inverse_length = light_delay ? ray.doppler(true).value : 1.0 / glm::length(ray.direction);
  point.to_camera = -ray.direction * inverse_length;
  point.normal = point.surface.normal;
  point.time = ray.at(hit.lambda).t;
  point.proper_time = point.time;
  const bool moves = surfaces.moves(hit.hit.surface);
  if (moves) go_along(ray, light_delay, point);
  const bool outside = glm::dot(point.normal, point.to_camera) >= 0.0;
  if (surfaces.is_smooth(hit.hit.surface)) {
    const Vec3& shading = point.surface.shading_normal;
    point.normal = moves ? normal_of_matter(point.matter, shading) : shading;
  }
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
  a.emission_time = way.emission_time;
  if (light.kind == LightKind::distant) a.segment.end = std::numeric_limits<double>::infinity();
  const auto& to_surface = view.to_frame[static_cast<std::size_t>(point.hit.frame)];
  const NullDirection<Rest> in_frame = to_surface(a.segment.direction);
  const NullDirection<Rest> k = point.matter(in_frame);
  if (!(k.length > 0.0)) return std::nullopt;
  const double inverse_length = 1.0 / k.length;
  a.to_light = k.x * inverse_length;
  a.cosine = glm::dot(point.normal, a.to_light);
  if (!(a.cosine > 0.0)) return std::nullopt;
  const auto lamp = boost_by<Source, Source>(way.velocity);
  if (light.cone) {
    a.share = light.cone->share(light.motion ? -lamp(way.direction).x : -way.direction.x, way.emission_time);
    if (!(a.share > 0.0)) return std::nullopt;
  }
  a.doppler = {k.length / (light.motion ? lamp(way.direction).length : way.direction.length)};
  a.gamma = light.motion ? gamma_of_lamp(point, to_surface, lamp) : gamma_between(point, to_surface);
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
