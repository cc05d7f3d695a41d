// A ray's way, from mirror to mirror: docs/physics.md section 11.
#include <algorithm>

#include "leg.h"
#include "shading_steps.h"

namespace backlight {
namespace {

// γ between what a leg starts from and the matter of the point that it meets.
double gamma_of(const Leg& leg, const SeenPoint& point, const FrameView& view) {
  if (leg.matter.is_identity()) return gamma_between(point, view.from_camera);
  const Displacement<Rest> u =
      view.from_camera(Displacement<Camera>{leg.matter.gamma(), leg.matter.celerity()});
  return point.matter.gamma() * u.t - glm::dot(point.matter.celerity(), u.x);
}

// How long a unit of λ is in the camera's frame.
double length_at_camera(const Leg& leg) {
  if (leg.relay == nullptr) return 1.0;
  return leg.relay->to_camera(NullDirection<Rest>{leg.ray.direction, leg.ray.length}).length;
}

}  // namespace

const Material& Tracer::material_at(const SeenPoint& point) const {
  return scene_->materials[static_cast<std::size_t>(material_of(*scene_, point.hit, point.surface))];
}

const Hub& Tracer::hub_of(const Leg& leg) const {
  return leg.relay != nullptr ? leg.relay->hub : hub_;
}

LinearRgb Tracer::colour_along(const Leg& leg, const FirstHit& hit, const Effects& effects, bool shifted,
                               Scratch& scratch) const {
  const Hub& hub = hub_of(leg);
  const int frame = hit.found() ? hit.frame : scene_->sky.frame;
  const RestRayEvents& events = scratch.rays.in(frame);

  // What carries light to the camera: L_camera(λ) = F D L_rest(Dλ), equation (8); F alone where colours stay,
  // (9). D is that of the whole way, as the ray's null vector is.
  const SeenPoint point = hit.found() ? seen_point(hub, scratch.rays, hit) : SeenPoint{};
  const DopplerFactor<Camera, Rest> doppler{events.doppler(leg.ray.light_delay).value * point.doppler};
  const double gamma = leg.gamma * gamma_of(leg, point, hub.frames[static_cast<std::size_t>(frame)]);
  const BrightnessSwitches& factors = leg.relay != nullptr ? effects.brightness : effects.towards_camera();
  ShadingContext context = shading();
  context.hub = &hub;

  const Material* passing = nullptr;
  if (relays_.any() && hit.found() && passes_on(material_at(point))) passing = &material_at(point);
  LinearRgb sum{0.0};
  if (passing != nullptr && !has_own_light(*passing)) {
    // Nothing but what is seen in it.
  } else if (!shifted) {
    // Light into the surface from its retarded event, shadow ray, reflection in the rest frame: (10)-(12).
    const Radiance<Rest> radiance =
        hit.found() ? shade(context, point, effects, scratch) : sky_radiance(scene_->sky, events);
    sum = leg.weight * carry(radiance, doppler, gamma, factors).rgb;
  } else {
    shift_by(doppler, scratch);
    const LinearRgb radiance = hit.found() ? shade_shifted(context, point, effects, scratch)
                                           : sky_shifted(context, sky_radiance(scene_->sky, events), scratch);
    sum = leg.weight *
          (radiance_factor(doppler, gamma, factors) * wavelength_density_factor(doppler) * radiance);
  }
  if (passing == nullptr) return sum;
  Leg next = mirrored(leg, point, doppler, scratch.rays);
  if (leg.ray.light_delay) next.gamma = gamma;
  return sum + colour_mirrored(next, *passing->mirror, doppler, effects, shifted, scratch);
}

LinearRgb Tracer::colour_mirrored(Leg& leg, const Colour& share, DopplerFactor<Camera, Rest> doppler,
                                  const Effects& effects, bool shifted, Scratch& scratch) const {
  const bool coloured = shifted && !share.spectrum.is_grey();
  if (!coloured) leg.weight *= share.rgb;
  if (share.spectrum.is_black() || leg.weight == LinearRgb{0.0}) return LinearRgb{0.0};
  if (leg.passed > scene_->film.bounces) {
    ++scratch.counts.ended;
    return LinearRgb{0.0};
  }
  ++scratch.counts.passed_on;
  if (coloured) scratch.filters.push_back({&share.spectrum, doppler.value});
  scratch.rays.start(leg.relay->hub, leg.ray);
  const FirstHit hit = first_hit(leg.relay->hub, scratch.rays);
  const LinearRgb colour = colour_along(leg, hit, effects, shifted, scratch);
  if (coloured) scratch.filters.pop_back();
  return colour;
}

// Equation (30): in the frame of the mirror's matter the ray's direction is reflected and its frequency kept.
// Without light delay the way to the mirror is no light's, and light arrives there as it does from a lamp.
Leg Tracer::mirrored(const Leg& leg, const SeenPoint& point, DopplerFactor<Camera, Rest> doppler,
                     const RayInFrames& rays) const {
  const Vec3 looking = -point.to_camera;
  const auto about = [&](const Vec3& normal) {
    return glm::normalize(looking - 2.0 * glm::dot(looking, normal) * normal);
  };
  Vec3 turned = about(point.normal);
  // By a mesh's smooth normals it may go into the mesh, near an outline.
  const bool smooth = hub_.frames[static_cast<std::size_t>(point.hit.frame)].scene->surfaces->is_smooth(
      point.hit.hit.surface);
  if (smooth && !(glm::dot(turned, point.side) > 0.0)) turned = about(point.side);
  const double length = leg.ray.light_delay ? 1.0 / doppler.value : 1.0;
  NullDirection<Rest> n{length * turned, length};
  if (!point.matter.is_identity()) n = boost_by<Rest, Rest>(-point.surface.velocity)(n);
  Leg next;
  next.relay = &relays_.of(point.hit.frame);
  next.passed = leg.passed + 1;
  next.weight = leg.weight;
  next.matter = point.matter;
  next.ray.direction = n.x;
  next.ray.length = n.length;
  next.ray.offset = relays_.since(leg.relay, rays, point.hit,
                                  point.surface.position + point.surface.error_bound * point.side);
  next.ray.displaced = true;
  return next;
}

MirrorRecord Tracer::seen_in_mirror(const CameraRay& ray, const FirstHit& first, Scratch& scratch) const {
  Leg leg{nullptr, ray};
  FirstHit hit = first;
  MirrorRecord record;
  record.distance = 0.0;
  for (;;) {
    const Hub& hub = hub_of(leg);
    const int frame = hit.found() ? hit.frame : scene_->sky.frame;
    const SeenPoint point = hit.found() ? seen_point(hub, scratch.rays, hit) : SeenPoint{};
    record.doppler = scratch.rays.in(frame).doppler(leg.ray.light_delay).value * point.doppler;
    // A null vector's length in the camera's frame is that of a unit of λ.
    record.distance += double(hit.lambda) * length_at_camera(leg);
    if (!hit.found()) {
      record.distance = std::numeric_limits<double>::infinity();
      return record;
    }
    if (!passes_on(material_at(point)) || leg.passed == scene_->film.bounces) {
      record.object_id = object_of(*scene_, hit).id;
      record.emission_time = scratch.rays.event(0, hit.lambda).t / scene_->c;
      return record;
    }
    leg = mirrored(leg, point, {record.doppler}, scratch.rays);
    scratch.rays.start(leg.relay->hub, leg.ray);
    hit = first_hit(leg.relay->hub, scratch.rays);
  }
}

}  // namespace backlight
