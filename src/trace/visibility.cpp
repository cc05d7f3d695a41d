#include "backlight/trace/visibility.h"

#include <algorithm>
#include <limits>

namespace backlight {

const Object& object_of(const Scene& scene, int frame, int surface) {
  const SceneFrame& of = scene.frames[static_cast<std::size_t>(frame)];
  return scene.objects[static_cast<std::size_t>(of.object_of_surface[static_cast<std::size_t>(surface)])];
}

const Object& object_of(const Scene& scene, const FirstHit& hit) {
  return object_of(scene, hit.frame, hit.hit.surface);
}

int material_of(const Scene& scene, const FirstHit& hit, const SurfacePoint& point) {
  const Object& object = object_of(scene, hit);
  return object.member_materials.empty() ? object.material
                                         : object.member_materials[static_cast<std::size_t>(point.member)];
}

namespace {

// A surface without bounds, met from the camera on: its distance there carries the rounding of an event that
// may be γ times farther away. So it is met again from close by.
FirstHit hit_of_unbounded(int surface, const FrameView& view, const CameraRay& ray,
                          const RestRayEvents& from_camera) {
  const SurfaceSet& surfaces = *view.scene->surfaces;
  const Hit rough =
      surfaces.first_crossing_of(surface, from_camera.origin, from_camera.direction, from_camera.clock());
  if (!rough.found()) return {};
  const double length = glm::length(from_camera.direction);
  const double room = 1e-12 * (rough.lambda + glm::length(from_camera.origin) / length);
  const RestRayEvents near = in_frame_from(view, ray, std::max(0.0, rough.lambda - room));
  FirstHit first;
  first.hit = surfaces.first_crossing_of(surface, near.origin, near.direction, near.clock());
  first.start = near.start;
  first.lambda = Extended(near.start) + Extended(first.hit.lambda);
  return first;
}

}  // namespace

FirstHit first_hit_in(int frame, const Hub& hub, RayInFrames& rays, double limit) {
  const FrameView& view = hub.frames[static_cast<std::size_t>(frame)];
  const SurfaceSet& surfaces = *view.scene->surfaces;
  const RestRayEvents& ray = rays.in(frame);
  const bool apart = view.far && !view.far->unbounded.empty();
  FirstHit first;
  first.hit = surfaces.nearest(ray.origin, ray.direction, limit - ray.start, ray.clock(), hub.search,
                               apart ? Among::bounded : Among::all);
  first.start = ray.start;
  first.lambda = Extended(ray.start) + Extended(first.hit.lambda);
  if (apart) {
    const RestRayEvents from_camera = in_frame_from(view, rays.ray(), 0.0);
    for (const int surface : view.far->unbounded) {
      const FirstHit other = hit_of_unbounded(surface, view, rays.ray(), from_camera);
      if (!other.found() || !(double(other.lambda) < limit)) continue;
      const bool same = other.lambda == first.lambda && surface < first.hit.surface;
      if (!first.found() || other.lambda < first.lambda || same) first = other;
    }
  }
  if (!first.found()) return {};
  first.frame = frame;
  return first;
}

FirstHit first_hit(const Hub& hub, RayInFrames& rays) {
  FirstHit first;
  double nearest = std::numeric_limits<double>::infinity();
  for (const int index : hub.occupied) {
    const FirstHit hit = first_hit_in(index, hub, rays, nearest);
    if (!hit.found()) continue;
    first = hit;
    nearest = double(first.lambda);
  }
  return first;
}

namespace {

// Whether a segment passes the bounds of a frame's surfaces by more than rounding: all of its numbers are
// doubles, of which `doubt` is unsure as a part of the way.
bool passes_by(const BoundingSphere& bounds, const Vec3& start, const Vec3& direction, double doubt) {
  if (bounds.radius < 0.0) return true;
  const Vec3 to_centre = bounds.centre - start;
  const double along = glm::dot(to_centre, direction) / glm::dot(direction, direction);
  const double room = 1.001 * bounds.radius + doubt * (glm::length(to_centre) + glm::length(start));
  const Vec3 miss = to_centre - along * direction;
  return glm::dot(miss, miss) > room * room;
}

// The shadow of a frame with a FarView on a point of another: the segment is brought next to the surfaces
// that have bounds as rays are.
bool is_shadowed_far(const FrameView& view, const LightView& light, const ExtendedEvent& start,
                     const ShadowSegment& segment, Search search) {
  const SurfaceSet& surfaces = *view.scene->surfaces;
  const ExtendedVec3 way{segment.direction.x};
  const ExtendedEvent along{-sqrt(dot(way, way)), way};
  const ExtendedEvent k = view.far->from_world(light.to_world ? (*light.to_world)(along) : along);
  RestRayEvents events{start.x.rounded(), k.x.rounded(), double(start.t), double(k.t), 0.0};
  for (const int surface : view.far->unbounded) {
    if (!surfaces.casts_shadow(surface)) continue;
    const Hit crossing = surfaces.first_crossing_of(surface, events.origin, events.direction, events.clock());
    if (crossing.lambda < segment.end) return true;
  }
  if (view.far->bounds.radius < 0.0) return false;
  events.start = start_near(view.far->bounds, events);
  if (!(events.start < segment.end)) return false;
  const Extended moved(events.start);
  events.origin = (start.x + moved * k.x).rounded();
  events.time = double(start.t + moved * k.t);
  return surfaces.blocked(events.origin, events.direction, segment.end - events.start, events.clock(), search,
                          Among::bounded);
}

}  // namespace

bool is_shadowed_in(int frame, const Hub& hub, RayInFrames& rays, const FirstHit& hit, const LightView& light,
                    const ShadowSegment& segment) {
  const FrameView& view = hub.frames[static_cast<std::size_t>(frame)];
  const SurfaceSet& surfaces = *view.scene->surfaces;
  if (frame == hit.frame) {
    return surfaces.blocked(segment.start_in_surface_frame, segment.direction_in_surface_frame, segment.end,
                            segment.clock_in_surface_frame, hub.search);
  }
  const auto& to_frame = light.to_frame[static_cast<std::size_t>(frame)];
  if (!light.retarded_shadows) {
    const Event<Rest> start = rays.in(frame).at(hit.lambda);
    const Displacement<Rest> now = to_frame(Displacement<Source>{0.0, segment.direction.x});
    return surfaces.blocked(start.x, now.x, segment.end, {start.t, now.t}, hub.search);
  }
  const NullDirection<Rest> direction = to_frame(segment.direction);
  if (!view.far) {
    const Event<Rest> start = rays.in(frame).at(hit.lambda);
    return surfaces.blocked(start.x, direction.x, segment.end, {start.t, -direction.length}, hub.search);
  }
  const ExtendedEvent start = far_event(*view.far, rays.ray(), hit.lambda);
  const double doubt = 1e-12 + 1e-14 * (to_frame.gamma() + view.from_camera.gamma());
  const bool bounded = view.far->unbounded.empty();
  if (bounded && passes_by(view.far->bounds, start.x.rounded(), direction.x, doubt)) return false;
  return is_shadowed_far(view, light, start, segment, hub.search);
}

bool is_shadowed(const Hub& hub, RayInFrames& rays, const FirstHit& hit, const LightView& light,
                 const ShadowSegment& segment) {
  return std::any_of(hub.occupied.begin(), hub.occupied.end(),
                     [&](int frame) { return is_shadowed_in(frame, hub, rays, hit, light, segment); });
}

}  // namespace backlight
