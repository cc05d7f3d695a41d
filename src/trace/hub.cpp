#include "backlight/trace/hub.h"

#include <cmath>
#include <limits>
#include <utility>

namespace backlight {
namespace {

std::vector<int> unbounded_of(const SurfaceSet& surfaces) {
  std::vector<int> unbounded;
  for (int i = 0; i < static_cast<int>(surfaces.size()); ++i) {
    if (!std::isfinite(surfaces.bounds(i).radius)) unbounded.push_back(i);
  }
  return unbounded;
}

// `events_wanted`: whether it is asked for events besides those on its surfaces.
FrameView view_of(const SceneFrame& frame, const Viewpoint& camera, double robust_from, bool events_wanted) {
  const ExtendedEvent event = to_frame(frame.motion, camera.event);
  FrameView view;
  view.from_camera = relative_transform<Rest, Camera>(frame.motion.celerity, camera.celerity, robust_from);
  view.camera_event = {double(event.t), event.x.rounded()};
  view.scene = &frame;
  if (view.from_camera.gamma() > robust_from && (events_wanted || frame.surfaces->size() > 0)) {
    view.far = std::make_shared<const FarView>(
        FarView{ExtendedTransform(frame.motion.celerity, camera.celerity),
                ExtendedTransform(frame.motion.celerity, {}), event, frame.surfaces->bounds_of_bounded(),
                unbounded_of(*frame.surfaces)});
  }
  return view;
}

LightView view_of(const Light& light, const Scene& scene, double robust_from) {
  const ExtendedVec3& own = scene.frames[static_cast<std::size_t>(light.frame)].motion.celerity;
  LightView view;
  view.light = &light;
  if (own != ExtendedVec3{}) view.to_world.emplace(ExtendedVec3{}, own);
  view.to_frame.reserve(scene.frames.size());
  for (const SceneFrame& frame : scene.frames) {
    view.to_frame.push_back(relative_transform<Rest, Source>(frame.motion.celerity, own, robust_from));
  }
  return view;
}

double robust_from(const ModelPieces& pieces) {
  return pieces.robust_arithmetic ? robust_gamma : std::numeric_limits<double>::infinity();
}

void add_frames(const Scene& scene, const Viewpoint& viewpoint, double robust_from, Hub& hub) {
  std::vector<bool> events_wanted(scene.frames.size(), false);
  events_wanted[0] = true;  // the time of emission is told in the world's
  for (const Light& light : scene.lights) events_wanted[static_cast<std::size_t>(light.frame)] = true;
  hub.frames.reserve(scene.frames.size());
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    hub.frames.push_back(view_of(scene.frames[i], viewpoint, robust_from, events_wanted[i]));
  }
}

}  // namespace

Hub make_hub(const Scene& scene, const ModelPieces& pieces, Search search) {
  Hub hub;
  hub.search = search;
  add_frames(scene, {scene.camera.celerity, scene.camera.event}, robust_from(pieces), hub);
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    if (scene.frames[i].surfaces->size() > 0) hub.occupied.push_back(static_cast<int>(i));
  }
  std::vector<LightView> lights;
  lights.reserve(scene.lights.size());
  for (const Light& light : scene.lights) {
    lights.push_back(view_of(light, scene, robust_from(pieces)));
    lights.back().retarded_shadows = pieces.retarded_shadows;
  }
  hub.lights = std::move(lights);
  const ExtendedVec3& sky = scene.frames[static_cast<std::size_t>(scene.sky.frame)].motion.celerity;
  hub.camera_from_sky = relative_transform<Camera, Rest>(scene.camera.celerity, sky, robust_from(pieces));
  return hub;
}

Hub make_hub(const Scene& scene, const Hub& camera, const Viewpoint& viewpoint, const ModelPieces& pieces) {
  Hub hub;
  hub.search = camera.search;
  hub.occupied = camera.occupied;
  hub.lights = camera.lights;
  add_frames(scene, viewpoint, robust_from(pieces), hub);
  const ExtendedVec3& sky = scene.frames[static_cast<std::size_t>(scene.sky.frame)].motion.celerity;
  hub.camera_from_sky = relative_transform<Camera, Rest>(viewpoint.celerity, sky, robust_from(pieces));
  return hub;
}

}  // namespace backlight
