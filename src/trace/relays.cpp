#include "backlight/trace/relays.h"

#include <algorithm>

namespace backlight {
namespace {

// About where, and when, the camera sees the frame's surfaces.
ExtendedEvent event_near(const SceneFrame& frame, const CameraView& camera) {
  const ExtendedEvent seen = to_frame(frame.motion, camera.event);
  const BoundingSphere& bounds = frame.surfaces->bounds_of_bounded();
  const ExtendedVec3 centre{bounds.radius >= 0.0 ? bounds.centre : Vec3{0.0}};
  const ExtendedVec3 way = centre - seen.x;
  return {seen.t - sqrt(dot(way, way)), centre};
}

}  // namespace

bool passes_light_on(const Scene& scene) {
  return std::ranges::any_of(scene.frames, [&](const SceneFrame& frame) { return passes_on(scene, frame); });
}

Relays::Relays(const Scene& scene, const Hub& camera, const ModelPieces& pieces) : camera_(&camera) {
  if (!passes_light_on(scene)) return;
  const std::size_t count = scene.frames.size();
  std::vector<std::unique_ptr<Relay>> made(count);
  std::vector<ExtendedEvent> in_world(count);
  for (std::size_t i = 0; i < count; ++i) {
    const SceneFrame& frame = scene.frames[i];
    if (!passes_on(scene, frame)) continue;
    made[i] = std::make_unique<Relay>();
    made[i]->event = event_near(frame, scene.camera);
    in_world[i] = to_world(frame.motion, made[i]->event);
    made[i]->hub = make_hub(scene, camera, {frame.motion.celerity, in_world[i]}, pieces);
    made[i]->to_camera = relative_transform<Camera, Rest>(scene.camera.celerity, frame.motion.celerity);
  }
  const auto times_since = [&](const ExtendedEvent& event) {
    std::vector<double> times(count, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
      if (made[i]) times[i] = double(to_frame(scene.frames[i].motion, event).t - made[i]->event.t);
    }
    return times;
  };
  camera_since_relay_ = times_since(scene.camera.event);
  for (std::size_t i = 0; i < count; ++i) {
    if (made[i]) made[i]->since_relay = times_since(in_world[i]);
  }
  for (auto& relay : made) relays_.push_back(std::move(relay));
}

Displacement<Camera> Relays::since(const Relay* from, const RayInFrames& rays, const FirstHit& hit,
                                   const Vec3& place) const {
  const auto frame = static_cast<std::size_t>(hit.frame);
  const FrameView& view = (from != nullptr ? from->hub : *camera_).frames[frame];
  const ExtendedEvent& event = relays_[frame]->event;
  const Vec3 way = place - event.x.rounded();
  const CameraRay& ray = rays.ray();
  if (view.far) return {double(far_event(*view.far, ray, hit.lambda).t - event.t), way};
  double time = (from != nullptr ? from->since_relay : camera_since_relay_)[frame];
  if (ray.displaced) time += view.from_camera(ray.offset).t;
  return {time + double(hit.lambda) * in_frame(view, ray).time_rate, way};
}

}  // namespace backlight
