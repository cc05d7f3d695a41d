#include "backlight/trace/tracer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "leg.h"
#include "light_record.h"
#include "passed_stars.h"
#include "shading_steps.h"

namespace backlight {
namespace {

CameraRay ray_of_eye(const CameraView& camera, const ImagePoint& point, const Vec3& direction,
                     bool light_delay, int eye) {
  const Lens& lens = camera.lens;
  CameraRay ray;
  ray.direction = direction;
  ray.light_delay = light_delay;
  if (eye == 0 || !camera.stereo) return ray;
  // The eyes are half the separation to either side. All around, they turn with the head: the viewer faces
  // each longitude in turn (omnidirectional stereo).
  Vec3 aside = lens.right;
  if (lens.projection == Projection::equirectangular) {
    const double longitude = (point.x / lens.width - 0.5) * 2.0 * std::numbers::pi;
    aside = std::cos(longitude) * lens.right - std::sin(longitude) * lens.forward;
  }
  ray.offset = {0.0, 0.5 * eye * camera.stereo->separation * aside};
  ray.displaced = true;
  return ray;
}

bool any_without_shift(const Scene& scene) {
  return !scene.effects.doppler || std::any_of(scene.regions.begin(), scene.regions.end(),
                                               [](const EffectsRegion& r) { return !r.effects.doppler; });
}

}  // namespace

Tracer::Tracer(const Scene& scene, int wavelengths, const ModelPieces& pieces, Search search)
    : scene_(&scene),
      hub_(make_hub(scene, pieces, search)),
      relays_(scene, hub_, pieces),
      wavelengths_(&wavelength_set(wavelengths > 0 ? wavelengths : default_wavelength_count)),
      spectral_(wavelengths > 0),
      stars_(star_images(scene, hub_, *wavelengths_)) {
  find_glass();
  if (relays_.any() && !scene.sky.stars.empty())
    passed_stars_ = std::make_shared<const PassedStars>(scene, hub_, *wavelengths_, camera_is_in_glass());
  const bool at_rest = !spectral_ || any_without_shift(scene) || records_light(scene);
  if (spectral_ || (at_rest && RestColours::needs_spectra(scene))) {
    spectra_ = SceneSpectra(scene, *wavelengths_);
  }
  if (at_rest) rest_colours_ = RestColours(scene, *wavelengths_, spectra_);
}

Scratch Tracer::make_scratch(InstructionSet set) const {
  return {hub_, spectral_ ? static_cast<std::size_t>(wavelengths_->most()) : 0, set};
}

RayLight Tracer::light(const CameraRay& ray, const Effects& effects, Scratch& scratch) const {
  // The ray in every frame with surfaces (docs/physics.md equations (3), (4)), the first hit in each back
  // along the past light cone, and the nearest of them: the smallest λ.
  scratch.rays.start(in_medium(ray));
  ++scratch.counts.primary;
  ++scratch.counts.single;
  const FirstHit hit = first_hit(hub_, scratch.rays);
  return {colour_of(ray, hit, effects, scratch), hit.found() || scene_->sky.given};
}

LinearRgb Tracer::colour_of(const CameraRay& ray, const FirstHit& hit, const Effects& effects,
                            Scratch& scratch) const {
  if (hit.hit.unresolved) ++scratch.counts.unresolved;
  return colour_of(camera_leg(ray), hit, effects, scratch);
}

LinearRgb Tracer::colour_of(const Leg& leg, const FirstHit& hit, const Effects& effects,
                            Scratch& scratch) const {
  return colour_along(leg, hit, effects, spectral_ && effects.doppler, scratch);
}

SurfaceRecord Tracer::surface(const CameraRay& ray, Scratch& scratch) const {
  scratch.rays.start(in_medium(ray));
  ++scratch.counts.data;
  return surface_of(ray, first_hit(hub_, scratch.rays), scratch);
}

SurfaceRecord Tracer::surface_of(const CameraRay& ray, const FirstHit& hit, Scratch& scratch) const {
  SurfaceRecord record;
  if (!hit.found()) {
    record.doppler = scratch.rays.in(scene_->sky.frame).doppler(ray.light_delay).value;
    return record;
  }
  const SeenPoint point = seen_point(hub_, scratch.rays, hit);
  record.object_id = object_of(*scene_, hit).id;
  record.distance = double(hit.lambda) * in_medium(ray).index;
  record.doppler = scratch.rays.in(hit.frame).doppler(ray.light_delay).value * point.doppler;
  record.emission_time = scratch.rays.event(0, hit.lambda).t / scene_->c;
  record.proper_time = point.proper_time / scene_->c;
  record.position = point.surface.position;
  record.normal = point.normal;
  record.unresolved = hit.hit.unresolved;
  if (relays_.any() && has_aov(*scene_, "mirror") && passes_on(material_at(point))) {
    record.mirror = seen_in_mirror(camera_leg(ray), hit, scratch);
  }
  return record;
}

LinearRgb Tracer::stars(int x, int y, int eye, Scratch& scratch) const {
  LinearRgb sum{0.0};
  const auto before = [](const StarImage& star, const std::pair<int, int>& pixel) {
    return star.y != pixel.second ? star.y < pixel.second : star.x < pixel.first;
  };
  auto star = std::lower_bound(stars_.begin(), stars_.end(), std::pair{x, y}, before);
  for (; star != stars_.end() && star->x == x && star->y == y; ++star) {
    const CameraRay ray =
        ray_of_eye(scene_->camera, {x + 0.5, y + 0.5}, star->direction, star->light_delay, eye);
    scratch.rays.start(ray);
    if (!first_hit(hub_, scratch.rays).found()) sum += star->radiance;
  }
  if (passed_stars_ == nullptr) return sum;
  const auto trace = [&](const ImagePoint& point, const Effects& effects, const Route* only) {
    const auto ray = camera_ray(scene_->camera, point, effects, eye);
    return ray ? escapes(*ray, effects, only, scratch) : std::vector<Escape>{};
  };
  return sum + passed_stars_->in_pixel(x, y, eye, trace);
}

std::optional<CameraRay> camera_ray(const CameraView& camera, const ImagePoint& point, const Effects& effects,
                                    int eye) {
  const auto direction = direction_at(camera.lens, point);
  if (!direction) return std::nullopt;
  return ray_of_eye(camera, point, *direction, effects.light_delay, eye);
}

}  // namespace backlight
