#include "glass.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "backlight/surface/encloses.h"

namespace backlight {

Media beyond(const Media& media, const Medium& of, bool entering) {
  Media left = media;
  if (entering) {
    left.push_back(of);
    return left;
  }
  const auto is_it = [&](const Medium& medium) { return medium.is(of.frame, of.surface); };
  const auto found = std::find_if(left.rbegin(), left.rend(), is_it);
  if (found != left.rend()) left.erase(std::next(found).base());
  return left;
}

Parting part(const Vec3& looking, const Vec3& normal, double index, double index_beyond) {
  if (index == index_beyond) return {0.0, looking};
  const double ratio = index / index_beyond;
  const double cosine = std::clamp(-glm::dot(looking, normal), 0.0, 1.0);
  const double square = 1.0 - ratio * ratio * (1.0 - cosine) * (1.0 + cosine);
  if (!(square > 0.0)) return {1.0, {}};
  const double beyond = std::sqrt(square);
  const double across = (index * cosine - index_beyond * beyond) / (index * cosine + index_beyond * beyond);
  const double within = (index_beyond * cosine - index * beyond) / (index_beyond * cosine + index * beyond);
  return {0.5 * (across * across + within * within),
          glm::normalize(ratio * looking + (ratio * cosine - beyond) * normal)};
}

std::vector<GlassSurface> glass_surfaces(const Scene& scene) {
  std::vector<GlassSurface> all;
  for (std::size_t frame = 0; frame < scene.frames.size(); ++frame) {
    const SharedVector<int>& objects = scene.frames[frame].object_of_surface;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const Object& object = scene.objects[static_cast<std::size_t>(objects[i])];
      const Glass* glass = scene.materials[static_cast<std::size_t>(object.material)].glass.get();
      if (glass != nullptr)
        all.push_back({static_cast<int>(frame), static_cast<int>(i), glass, object.casts_shadow});
    }
  }
  return all;
}

namespace {

struct Crossing {
  double lambda;
  const GlassSurface* of;
  bool entering;
  double cosine;  // of the line and the normal
  double doubt;   // of λ
};

// All of one surface with a line, in order, up to `end`; if there is none, the next beyond, which tells
// whether the line is inside. Infinity of a body without bounds that it is in and never leaves.
void add_crossings(const SurfaceSet& surfaces, const GlassSurface& of, const Vec3& origin,
                   const Vec3& direction, const RayClock& clock, double end,
                   std::vector<Crossing>& crossings) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const double length = glm::length(direction);
  constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();
  double from = 0.0, skip = 0.0;
  bool any = false;
  do {
    const Vec3 start = origin + from * direction;
    const RayClock then{clock.start + from * clock.rate, clock.rate};
    const Hit hit = surfaces.first_crossing_of(of.surface, start, direction, then);
    if (any && !(from + hit.lambda < end)) return;
    if (!hit.found()) {
      if (!any && std::isinf(surfaces.bounds(of.surface).radius) && encloses(surfaces, of.surface, origin))
        crossings.push_back({never, &of, false, 1.0, 0.0});
      return;
    }
    any = true;
    const SurfacePoint point = surfaces.resolve(hit, start, direction, then);
    const double cosine = glm::dot(point.normal, direction) / length;
    const double doubt = 2.0 * point.error_bound / (length * std::max(std::abs(cosine), 1e-3));
    crossings.push_back({from + hit.lambda, &of, cosine < 0.0, std::abs(cosine), doubt});
    // A line that grazes the surface is within the doubt for long: steps grow until it is off.
    skip = std::max({doubt, rounding * from, hit.lambda <= skip ? 2.0 * skip : 0.0});
    from += hit.lambda + skip;
  } while (from < end);
}

// The glass around where a line begins: what it leaves before it enters.
Media around_start(const std::vector<Crossing>& crossings) {
  Media media;
  std::vector<const GlassSurface*> known;
  for (const Crossing& crossing : crossings) {
    if (std::ranges::find(known, crossing.of) != known.end()) continue;
    known.push_back(crossing.of);
    if (!crossing.entering)
      media.insert(media.begin(), {crossing.of->frame, crossing.of->surface, crossing.of->glass});
  }
  return media;
}

}  // namespace

Media media_at_camera(const Scene& scene, const std::vector<GlassSurface>& surfaces, const Hub& hub) {
  std::vector<Crossing> crossings;
  const Vec3 way{0.36, 0.48, 0.8};  // any
  for (const GlassSurface& of : surfaces) {
    const auto frame = static_cast<std::size_t>(of.frame);
    const FrameView& view = hub.frames[frame];
    if (!view.from_camera.is_identity()) continue;
    add_crossings(*scene.frames[frame].surfaces, of, view.camera_event.x, way, {}, 0.0, crossings);
  }
  std::ranges::stable_sort(crossings, {}, &Crossing::lambda);
  return around_start(crossings);
}

FramesBeside frames_beside(const Scene& scene, const std::vector<GlassSurface>& surfaces) {
  FramesBeside beside(scene.frames.size());
  for (const GlassSurface& glass : surfaces) {
    auto& its = beside[static_cast<std::size_t>(glass.frame)];
    if (!its.empty()) continue;
    its.push_back({glass.frame, {}});
    const InertialFrame& own = scene.frames[static_cast<std::size_t>(glass.frame)].motion;
    for (std::size_t i = 0; i < scene.frames.size(); ++i) {
      const InertialFrame& other = scene.frames[i].motion;
      const bool rests = other.celerity == own.celerity && scene.frames[i].surfaces->size() > 0;
      if (!rests || static_cast<int>(i) == glass.frame) continue;
      const ExtendedEvent shift = to_frame(other, own.origin);
      const Displacement<Rest> by{double(shift.t), shift.x.rounded()};
      constexpr double roundings = 16.0 * std::numeric_limits<double>::epsilon();
      its.push_back({static_cast<int>(i), by, roundings * glm::length(by.x)});
    }
  }
  return beside;
}

namespace {

// What of one frame stands on a point of glass. Its surface and the glass's are one, and which is met first
// is rounding: from just before both, all are asked for.
void add_contacts(const Scene& scene, const FrameBeside& beside, const SeenPoint& point, Contact& contact) {
  const SurfaceSet& surfaces = *scene.frames[static_cast<std::size_t>(beside.frame)].surfaces;
  const bool own = beside.frame == point.hit.frame;
  const double near = 2.0 * (point.surface.error_bound + beside.doubt);
  const Vec3 start = point.surface.position + beside.shift.x + near * point.side;
  const RayClock clock{point.time + beside.shift.t, 0.0};
  for (int i = 0; i < static_cast<int>(surfaces.size()); ++i) {
    if (own && i == point.hit.hit.surface) continue;
    const BoundingSphere ball = surfaces.bounds(i);
    if (glm::length(start - ball.centre) > 1.001 * ball.radius + 4.0 * near) continue;
    const Hit hit = surfaces.first_crossing_of(i, start, -point.side, clock);
    if (!(hit.lambda <= 2.0 * near)) continue;
    const SurfacePoint there = surfaces.resolve(hit, start, -point.side, clock);
    const Object& object = object_of(scene, beside.frame, i);
    const Glass* glass = scene.materials[static_cast<std::size_t>(object.material)].glass.get();
    if (!own) contact.room = std::max(contact.room, near);
    if (glass == nullptr) {
      contact.opaque = i;
      contact.frame = beside.frame;
    } else {
      contact.media =
          beyond(contact.media, {beside.frame, i, glass}, glm::dot(there.normal, point.side) > 0.0);
    }
  }
}

}  // namespace

Contact contact_at(const Scene& scene, const FramesBeside& beside, const SeenPoint& point,
                   const Media& before, const Media& media) {
  Contact contact{media};
  for (const FrameBeside& frame : beside[static_cast<std::size_t>(point.hit.frame)])
    add_contacts(scene, frame, point, contact);
  if (contact.opaque >= 0) contact.media = before;
  return contact;
}

LinearRgb transmitted(const std::vector<GlassSurface>& surfaces, const Hub& hub, Scratch& scratch,
                      const SeenPoint& point, const LightView& light, const Arrival& arrival, bool shifted) {
  std::vector<Crossing> crossings;
  std::vector<double> length_in(hub.frames.size(), 0.0);  // of the whole way
  for (const GlassSurface& of : surfaces) {
    if (!of.shades) continue;
    const auto frame = static_cast<std::size_t>(of.frame);
    Vec3 start = arrival.segment.start_in_surface_frame, way = arrival.segment.direction_in_surface_frame;
    RayClock clock = arrival.segment.clock_in_surface_frame;
    if (of.frame != point.hit.frame) {
      const NullDirection<Rest> n = light.to_frame[frame](arrival.segment.direction);
      const Event<Rest> event = scratch.rays.event(of.frame, point.hit.lambda);
      start = event.x;
      way = n.x;
      clock = {event.t, -n.length};
    }
    length_in[frame] = glm::length(way);
    add_crossings(*hub.frames[frame].scene->surfaces, of, start, way, clock, arrival.segment.end, crossings);
  }
  if (crossings.empty()) return LinearRgb{1.0};
  std::ranges::stable_sort(crossings, {}, &Crossing::lambda);
  // ω at the point over ω in the glass is as the lengths of one null vector.
  const double at_point = light.light->kind == LightKind::distant
                              ? arrival.doppler.value * arrival.segment.direction.length
                              : std::sqrt(1.0 / arrival.inverse_square);
  LinearRgb share{1.0};
  const auto absorb = [&](const Media& media, double from, double to) {
    if (media.empty() || !media.back().glass->tinted) return;
    const Colour& tint = media.back().glass->tint;
    const double whole = length_in[static_cast<std::size_t>(media.back().frame)];
    const double length = (to - from) * whole;
    if (shifted && !tint.spectrum.is_grey()) {
      scratch.filters.push_back({&tint.spectrum, scratch.shift * at_point / whole, length});
    } else {
      share *= glm::pow(tint.rgb, LinearRgb{length});
    }
  };
  Media media = around_start(crossings);
  double from = 0.0;
  const double end = arrival.segment.end;
  for (auto crossing = crossings.begin(); crossing != crossings.end() && crossing->lambda < end;) {
    absorb(media, from, crossing->lambda);
    const double cosine = crossing->cosine;
    from = crossing->lambda;
    // Where bodies touch, both surfaces are one.
    Media next = media;
    do {
      const Medium of{crossing->of->frame, crossing->of->surface, crossing->of->glass};
      next = beyond(next, of, crossing->entering);
      ++crossing;
    } while (crossing != crossings.end() &&
             crossing->lambda - std::prev(crossing)->lambda <= crossing->doubt + std::prev(crossing)->doubt);
    const Vec3 looking{std::sqrt((1.0 - cosine) * (1.0 + cosine)), 0.0, -cosine};
    // The angle is taken for that on the side of the lower index: on a way that is not bent the other one
    // would reflect all where nothing does.
    const double low = std::min(index_of(media), index_of(next));
    const double high = std::max(index_of(media), index_of(next));
    share *= 1.0 - part(looking, {0.0, 0.0, 1.0}, low, high).reflected;
    media = next;
  }
  absorb(media, from, end);
  return share;
}

}  // namespace backlight
