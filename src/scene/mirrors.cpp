// What mirrors and glass do not show.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "backlight/surface/encloses.h"
#include "things.h"

namespace backlight {
namespace {

// The middle of the eyes, and where they are if there are two; all around, wherever the head turns.
std::vector<Vec3> eyes_of(const CameraView& camera) {
  std::vector<Vec3> eyes{Vec3{0.0}};
  if (!camera.stereo) return eyes;
  for (const double side : {-0.5, 0.5}) {
    eyes.push_back(side * camera.stereo->separation * camera.lens.right);
    if (camera.lens.projection == Projection::equirectangular)
      eyes.push_back(side * camera.stereo->separation * camera.lens.forward);
  }
  return eyes;
}

// Of one body of glass: whether the camera can be where it is.
void check_camera_against(Compilation& c, const SceneFrame& frame, int surface) {
  const CameraView& camera = c.scene.camera;
  const auto motion = relative_transform<Rest, Camera>(frame.motion.celerity, camera.celerity);
  const Vec3 middle = to_frame(frame.motion, camera.event).x.rounded();
  const std::vector<Vec3> eyes = eyes_of(camera);
  const auto inside = std::ranges::count_if(eyes, [&](const Vec3& eye) {
    return encloses(*frame.surfaces, surface, middle + motion(Displacement<Camera>{0.0, eye}).x);
  });
  if (inside == 0) return;
  const bool moves = !motion.is_identity();
  if (!moves && inside == static_cast<std::ptrdiff_t>(eyes.size())) return;
  const Thing thing = camera_thing(c);
  const Thing glass = object_thing(c, frame.object_of_surface[static_cast<std::size_t>(surface)]);
  const std::string name = beside(c, glass, thing);
  c.values.diagnostics.error(
      c.values.description.span(thing.place),
      moves ? thing.name + " is in the glass of " + name + ", and moves relative to it"
            : "one eye of " + thing.name + " is in the glass of " + name + ", and another is not",
      moves ? "what is in glass must be at rest in its frame" : "a smaller 'separation' may do");
}

}  // namespace

void check_camera_in_glass(Compilation& c) {
  for (const SceneFrame& frame : c.scene.frames) {
    for (std::size_t i = 0; i < frame.object_of_surface.size(); ++i) {
      const Object& object = c.scene.objects[static_cast<std::size_t>(frame.object_of_surface[i])];
      if (c.scene.materials[static_cast<std::size_t>(object.material)].glass == nullptr) continue;
      check_camera_against(c, frame, static_cast<int>(i));
    }
  }
}

void tell_of_mirrors(Compilation& c) {
  if (std::exchange(c.parts.mirrors_are_told_of, true) || c.scene.sky.stars.empty()) return;
  const auto passes = [&](const SceneFrame& frame) { return passes_on(c.scene, frame); };
  if (std::ranges::none_of(c.scene.frames, passes)) return;
  const Node& background = find(c.values.description.root, "background")->node;
  c.values.diagnostics.warning(c.values.description.span(find(background, "stars")->node.place),
                               "stars, which are points, are not seen in mirrors, nor through glass",
                               "a 'texture' of the background is");
}

}  // namespace backlight
