// The light of a ray's way, through mirrors and glass: docs/physics.md sections 11 and 12.
#include <algorithm>
#include <array>
#include <optional>

#include "escape.h"
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

// Whether the ray from this mirror is to go in a sheet: as lanes can weigh its light, by red, green and blue.
bool is_wanted(const PassedOn& from, const Effects& effects, const Scratch& scratch) {
  const LegWanted* wanted = scratch.leg_wanted;
  if (wanted == nullptr || wanted->passed != from.leg.passed) return false;
  const bool by_gamma = effects.brightness.arrival_rate == ArrivalRate::dilation;
  return !by_gamma && from.leg.media.empty() && scratch.filters.empty() &&
         (*wanted->relays)[static_cast<std::size_t>(from.point.hit.frame)];
}

// Whether the search goes on by this leg, which is then the last of its route so far.
bool takes(EscapeSearch& search, const Leg& leg) {
  const auto before = static_cast<std::size_t>(leg.passed - 1);
  if (search.only != nullptr && (before >= search.only->size() || (*search.only)[before] != leg.route))
    return false;
  search.so_far.resize(before);
  search.so_far.push_back(leg.route);
  return true;
}

double largest(const LinearRgb& rgb) {
  return std::max({rgb.r, rgb.g, rgb.b});
}

}  // namespace

LinearRgb Tracer::colour_along(const Leg& leg, const FirstHit& hit, const Effects& effects, bool shifted,
                               Scratch& scratch) const {
  if (leg.media.empty()) return colour_at(leg, hit, effects, shifted, scratch);
  require_rest_in_glass(leg, hit);
  const Glass& glass = *leg.media.back().glass;
  if (!glass.tinted) return colour_at(leg, hit, effects, shifted, scratch);
  Leg through = leg;
  const std::size_t filters = scratch.filters.size();
  const double length = double(hit.lambda) * leg.ray.length;
  if (shifted && !glass.tint.spectrum.is_grey()) {
    scratch.filters.push_back({&glass.tint.spectrum, 1.0 / leg.ray.length, length});
  } else {
    through.weight *= glm::pow(glass.tint.rgb, LinearRgb{length});
  }
  const LinearRgb colour = colour_at(through, hit, effects, shifted, scratch);
  scratch.filters.resize(filters);
  return colour;
}

LinearRgb Tracer::colour_at(const Leg& leg, const FirstHit& hit, const Effects& effects, bool shifted,
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
  if (scratch.escapes != nullptr && !hit.found() && leg.passed > 0) {
    const auto shift = shifted ? doppler : DopplerFactor<Camera, Rest>{};
    scratch.escapes->found.push_back({scratch.escapes->so_far, glm::normalize(events.direction), shift,
                                      radiance_factor(doppler, gamma, factors) * leg.weight,
                                      scratch.filters});
  } else if (scratch.escapes != nullptr) {
    // Nothing but what is passed on.
  } else if (passing != nullptr && !has_own_light(*passing)) {
    // The same.
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
  // Without light delay no light came along the leg, and none of its γ counts.
  const PassedOn from{leg, point, doppler, leg.ray.light_delay ? gamma : 1.0};
  return sum + (passing->glass ? colour_parted(from, *passing->glass, effects, shifted, scratch)
                               : colour_mirrored(from, *passing->mirror, effects, shifted, scratch));
}

LinearRgb Tracer::colour_mirrored(const PassedOn& from, const Colour& share, const Effects& effects,
                                  bool shifted, Scratch& scratch) const {
  if (share.spectrum.is_black()) return LinearRgb{0.0};
  Leg next = mirrored(from, scratch.rays);
  const bool coloured = shifted && !share.spectrum.is_grey();
  if (!coloured) next.weight *= share.rgb;
  if (!coloured && is_wanted(from, effects, scratch)) {
    if (!goes_on(next, scratch)) return LinearRgb{0.0};
    scratch.leg_wanted->leg = next;
    scratch.leg_wanted->frame = from.point.hit.frame;
    return LinearRgb{0.0};
  }
  if (coloured) scratch.filters.push_back({&share.spectrum, from.doppler.value});
  const LinearRgb colour = follow(next, effects, shifted, scratch);
  if (coloured) scratch.filters.pop_back();
  return colour;
}

// Equations (34) and (35): both parts, each as long as it may still be seen.
LinearRgb Tracer::colour_parted(const PassedOn& from, const Glass& glass, const Effects& effects,
                                bool shifted, Scratch& scratch) const {
  const SeenPoint& point = from.point;
  const bool entering = glm::dot(point.side, point.surface.normal) > 0.0;
  const Medium of{point.hit.frame, point.hit.hit.surface, &glass};
  const Contact contact =
      contact_at(*scene_, *beside_, point, from.leg.media, beyond(from.leg.media, of, entering));
  const Parting parting =
      part(-point.to_camera, point.normal, index_of(from.leg.media), index_of(contact.media));
  const double seen = largest(from.leg.weight);
  const double faintest = scratch.escapes != nullptr ? faintest_star_ : faintest_;
  std::array<std::optional<Leg>, 2> parts;
  if (parting.reflected * seen > faintest) {
    parts[0] = mirrored(from, scratch.rays);
    parts[0]->weight *= parting.reflected;
  }
  if (parting.refracted && (1.0 - parting.reflected) * seen > faintest) {
    parts[1] = refracted(from, *parting.refracted, contact, scratch.rays);
    parts[1]->weight *= 1.0 - parting.reflected;
  }
  LinearRgb sum{0.0};
  for (const std::optional<Leg>& leg : parts) {
    if (leg) sum += follow(*leg, effects, shifted, scratch);
  }
  return sum;
}

// No light of surfaces is asked for, so that this costs no more than finding the way.
std::vector<Escape> Tracer::escapes(const CameraRay& ray, const Effects& effects, const Route* only,
                                    Scratch& scratch) const {
  EscapeSearch search{only};
  scratch.rays.start(in_medium(ray));
  const Lent lent(scratch.escapes, search);
  colour_along(camera_leg(ray), first_hit(hub_, scratch.rays), effects, effects.doppler, scratch);
  return std::move(search.found);
}

bool Tracer::goes_on(const Leg& leg, Scratch& scratch) const {
  if (leg.weight == LinearRgb{0.0}) return false;
  if (leg.passed > scene_->film.bounces) {
    if (scratch.escapes == nullptr) ++scratch.counts.ended;
    return false;
  }
  ++scratch.counts.passed_on;
  return true;
}

LinearRgb Tracer::follow(const Leg& leg, const Effects& effects, bool shifted, Scratch& scratch) const {
  if (scratch.escapes != nullptr && !takes(*scratch.escapes, leg)) return LinearRgb{0.0};
  if (!goes_on(leg, scratch)) return LinearRgb{0.0};
  return colour_along(leg, start(leg, scratch), effects, shifted, scratch);
}

}  // namespace backlight
