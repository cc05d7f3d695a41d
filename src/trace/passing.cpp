// How a ray goes on: docs/physics.md sections 11 and 12.
#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "backlight/camera/sample_digits.h"
#include "leg.h"
#include "matter_normal.h"

namespace backlight {
namespace {

std::uint64_t route_after(const PassedOn& from, std::uint64_t how) {
  const auto frame = static_cast<std::uint64_t>(from.point.hit.frame);
  const auto surface = static_cast<std::uint64_t>(from.point.hit.hit.surface);
  return mixed(mixed(2 * surface + how) + frame);
}

// How long a unit of λ is in the camera's frame, of light.
double length_at_camera(const Leg& leg) {
  if (leg.relay == nullptr) return leg.ray.index;
  const Displacement<Camera> way =
      leg.relay->to_camera(Displacement<Rest>{-leg.ray.index * leg.ray.length, leg.ray.direction});
  return -way.t;
}

std::string name_of(const Object& object) {
  return object.name.empty() ? "object " + std::to_string(object.id) : "'" + object.name + "'";
}

}  // namespace

const Material& Tracer::material_at(const SeenPoint& point) const {
  return scene_->materials[static_cast<std::size_t>(material_of(*scene_, point.hit, point.surface))];
}

const Hub& Tracer::hub_of(const Leg& leg) const {
  return leg.relay != nullptr ? leg.relay->hub : hub_;
}

CameraRay Tracer::in_medium(CameraRay ray) const {
  if (camera_is_in_glass()) ray.index = index_of(*camera_media_);
  return ray;
}

Leg Tracer::camera_leg(const CameraRay& ray) const {
  Leg leg{nullptr, in_medium(ray)};
  if (camera_is_in_glass()) leg.media = *camera_media_;
  return leg;
}

// How faint a part of light still shows: half a step of an 8-bit screen at black, or the tolerance, of the
// brightest that is known beforehand.
void Tracer::find_glass() {
  auto glass = std::make_shared<std::vector<GlassSurface>>(glass_surfaces(*scene_));
  glass_ = glass;
  beside_ = std::make_shared<const FramesBeside>(frames_beside(*scene_, *glass));
  if (glass->empty()) return;
  constexpr double half_step = 0.5 / 255.0 / 12.92;
  double brightest = 1.0;
  const auto shines = [&](const LinearRgb& rgb, int frame) {
    const auto& motion = hub_.frames[static_cast<std::size_t>(frame)].from_camera;
    const DopplerFactor<Camera, Rest> doppler{motion.gamma() + glm::length(motion.celerity())};
    const BrightnessSwitches& on = scene_->effects.towards_camera();
    brightest =
        std::max(brightest, std::max({rgb.r, rgb.g, rgb.b}) * radiance_factor(doppler, motion.gamma(), on));
  };
  if (scene_->sky.emits)
    shines(scene_->sky.texture ? LinearRgb{scene_->sky.texture_scale} : scene_->sky.radiance.rgb,
           scene_->sky.frame);
  for (const int frame : hub_.occupied) {
    for (const int object : scene_->frames[static_cast<std::size_t>(frame)].object_of_surface) {
      const auto material =
          static_cast<std::size_t>(scene_->objects[static_cast<std::size_t>(object)].material);
      const auto& emission = scene_->materials[material].emission;
      if (emission) shines(emission->rgb, frame);
    }
  }
  faintest_ = half_step / brightest;
  if (scene_->film.tolerance > 0.0) faintest_ = std::min(half_step, scene_->film.tolerance) / brightest;
  const FrameView& sky = hub_.frames[static_cast<std::size_t>(scene_->sky.frame)];
  faintest_star_ = std::min(faintest_, half_step / brightest_star(*scene_, sky, *wavelengths_));
  camera_media_ = std::make_shared<const std::vector<Medium>>(media_at_camera(*scene_, *glass, hub_));
}

bool Tracer::camera_is_in_glass() const {
  return camera_media_ != nullptr && !camera_media_->empty();
}

// From off the surface, on the side of `beyond`, in the direction of a null vector of its matter's frame.
Leg Tracer::passed_on(const PassedOn& from, const Vec3& way, const Vec3& beyond,
                      const RayInFrames& rays) const {
  const SeenPoint& point = from.point;
  // Without light delay the way there is no light's, and light arrives as it does from a lamp.
  const double length = from.leg.ray.light_delay ? 1.0 / from.doppler.value : 1.0;
  NullDirection<Rest> n{length * way, length};
  if (!point.matter.is_identity()) n = boost_by<Rest, Rest>(-point.surface.velocity)(n);
  Leg next;
  next.relay = &relays_.of(point.hit.frame);
  next.passed = from.leg.passed + 1;
  next.weight = from.leg.weight;
  next.gamma = from.gamma;
  next.matter = point.matter;
  next.ray.direction = n.x;
  next.ray.length = n.length;
  next.ray.offset = relays_.since(from.leg.relay, rays, point.hit, point.surface.position + beyond);
  next.ray.displaced = true;
  return next;
}

// Equation (30): in the frame of the matter the ray's direction is reflected and its frequency kept.
Leg Tracer::mirrored(const PassedOn& from, const RayInFrames& rays) const {
  const SeenPoint& point = from.point;
  const Vec3 looking = -point.to_camera;
  const auto about = [&](const Vec3& normal) {
    return glm::normalize(looking - 2.0 * glm::dot(looking, normal) * normal);
  };
  Vec3 turned = about(point.normal);
  // By a mesh's smooth normals it may go into the mesh, near an outline.
  const SurfaceSet& surfaces = *hub_.frames[static_cast<std::size_t>(point.hit.frame)].scene->surfaces;
  const bool smooth = surfaces.is_smooth(point.hit.hit.surface);
  const bool rests = point.matter.is_identity();
  const Vec3 facet = smooth && !rests ? normal_of_matter(point.matter, point.side) : point.side;
  if (smooth && !(glm::dot(turned, facet) > 0.0)) turned = about(facet);
  Leg next = passed_on(from, turned, point.surface.error_bound * point.side, rays);
  next.media = from.leg.media;
  next.ray.index = index_of(next.media);
  next.route = route_after(from, 0);
  return next;
}

Leg Tracer::refracted(const PassedOn& from, const Vec3& way, const Contact& contact,
                      const RayInFrames& rays) const {
  const SeenPoint& point = from.point;
  // What stands on the glass is met from this side of both, so that the ray cannot slip between them.
  const double error = point.surface.error_bound;
  const double beyond = contact.opaque >= 0 ? std::max(2.0 * error, contact.room) : -error - contact.room;
  Leg next = passed_on(from, way, beyond * point.side, rays);
  next.media = contact.media;
  next.ray.index = index_of(next.media);
  next.contact = contact.opaque;
  next.frame = contact.frame;
  next.route = route_after(from, 1);
  return next;
}

FirstHit Tracer::start(const Leg& leg, Scratch& scratch) const {
  const Hub& hub = leg.relay->hub;
  scratch.rays.start(hub, leg.ray);
  if (leg.contact < 0) return first_hit(hub, scratch.rays);
  const RestRayEvents& ray = scratch.rays.in(leg.frame);
  const SurfaceSet& surfaces = *hub.frames[static_cast<std::size_t>(leg.frame)].scene->surfaces;
  FirstHit hit;
  hit.hit = surfaces.first_crossing_of(leg.contact, ray.origin, ray.direction, ray.clock());
  if (!hit.found()) return first_hit(hub, scratch.rays);
  hit.frame = leg.frame;
  hit.lambda = Extended(hit.hit.lambda);
  return hit;
}

// What moves in glass would drag it along, or cut through it: that is not computed.
void Tracer::require_rest_in_glass(const Leg& leg, const FirstHit& hit) const {
  const Medium& medium = leg.media.back();
  const Hub& hub = hub_of(leg);
  const int frame = hit.found() ? hit.frame : scene_->sky.frame;
  const FrameView& view = hub.frames[static_cast<std::size_t>(frame)];
  const bool turns = hit.found() && view.scene->surfaces->moves(hit.hit.surface);
  const bool seen = hit.found() || scene_->sky.emits || !scene_->sky.stars.empty();
  if (!seen || (view.from_camera.is_identity() && !turns)) return;
  const std::string what = hit.found() ? name_of(object_of(*scene_, hit)) : "the background";
  throw std::runtime_error(what + " moves relative to the glass of " +
                           name_of(object_of(*scene_, medium.frame, medium.surface)) +
                           ", and is met in it: what is in glass must be at rest in its frame");
}

MirrorRecord Tracer::seen_in_mirror(const Leg& camera, const FirstHit& first, Scratch& scratch) const {
  Leg leg = camera;
  FirstHit hit = first;
  MirrorRecord record;
  record.distance = 0.0;
  for (;;) {
    if (!leg.media.empty()) require_rest_in_glass(leg, hit);
    const int frame = hit.found() ? hit.frame : scene_->sky.frame;
    const SeenPoint point = hit.found() ? seen_point(hub_of(leg), scratch.rays, hit) : SeenPoint{};
    record.doppler = scratch.rays.in(frame).doppler(leg.ray.light_delay).value * point.doppler;
    record.distance += double(hit.lambda) * length_at_camera(leg);
    if (!hit.found()) {
      record.distance = std::numeric_limits<double>::infinity();
      return record;
    }
    const Material& material = material_at(point);
    if (!passes_on(material) || leg.passed == scene_->film.bounces) {
      record.object_id = object_of(*scene_, hit).id;
      record.emission_time = scratch.rays.event(0, hit.lambda).t / scene_->c;
      return record;
    }
    leg = main_part({leg, point, {record.doppler}, 1.0}, material, scratch.rays);
    hit = start(leg, scratch);
  }
}

// Where glass is entered or left, what is refracted, unless all is reflected.
Leg Tracer::main_part(const PassedOn& from, const Material& material, const RayInFrames& rays) const {
  if (!material.glass) return mirrored(from, rays);
  const SeenPoint& point = from.point;
  const bool entering = glm::dot(point.side, point.surface.normal) > 0.0;
  const Medium of{point.hit.frame, point.hit.hit.surface, material.glass.get()};
  const Contact contact =
      contact_at(*scene_, *beside_, point, from.leg.media, beyond(from.leg.media, of, entering));
  const Parting parting =
      part(-point.to_camera, point.normal, index_of(from.leg.media), index_of(contact.media));
  return parting.refracted ? refracted(from, *parting.refracted, contact, rays) : mirrored(from, rays);
}

}  // namespace backlight
