// What may not be in glass.
#include <algorithm>
#include <cmath>
#include <string>
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

// Calls look(frame, surface) for each body of glass.
template <class Look>
void for_each_glass(const Scene& scene, const Look& look) {
  for (const SceneFrame& frame : scene.frames) {
    for (std::size_t i = 0; i < frame.object_of_surface.size(); ++i) {
      const Object& object = scene.objects[static_cast<std::size_t>(frame.object_of_surface[i])];
      if (scene.materials[static_cast<std::size_t>(object.material)].glass != nullptr)
        look(frame, static_cast<int>(i));
    }
  }
}

// Finds matter that moves relative to the glass which it is seen in. Where light goes straight to it: what is
// seen by refraction alone, or by reflection, is told when it is met.
class MatterInGlass {
 public:
  explicit MatterInGlass(Compilation& c) : c_(c) {}

  void look_into(const SceneFrame& glass, int surface) {
    for (const SceneFrame& other : c_.scene.frames) {
      const bool rests = other.motion.celerity == glass.motion.celerity;
      if (rests && !other.surfaces->any_moves()) continue;
      for (std::size_t i = 0; i < other.object_of_surface.size(); ++i) {
        const int its = static_cast<int>(i);
        if ((rests && !other.surfaces->moves(its)) || !is_seen_in(other, its, glass, surface)) continue;
        tell(other.object_of_surface[i], glass.object_of_surface[static_cast<std::size_t>(surface)]);
      }
    }
  }

 private:
  // Whether the middle of what is at rest in a frame, or one of six points around it, is in the glass when
  // the camera sees it.
  [[nodiscard]] bool is_seen_in(const SceneFrame& frame, int surface, const SceneFrame& glass,
                                int body) const {
    const BoundingSphere ball = frame.surfaces->bounds(surface);
    if (!std::isfinite(ball.radius)) return false;
    const BoundingSphere around = glass.surfaces->bounds(body);
    const ExtendedEvent eye = to_frame(frame.motion, c_.scene.camera.event);
    constexpr double within = 0.99;  // of a ball: what only touches does not count
    for (int i = 0; i < 7; ++i) {
      Vec3 place = ball.centre;
      if (i > 0) place[i % 3] += (i > 3 ? -within : within) * ball.radius;
      const ExtendedVec3 way = ExtendedVec3{place} - eye.x;
      const ExtendedEvent seen{eye.t - sqrt(dot(way, way)), ExtendedVec3{place}};
      const Vec3 there = to_frame(glass.motion, to_world(frame.motion, seen)).x.rounded();
      const double apart = glm::length(there - around.centre);
      if (i == 0 && apart > around.radius + ball.radius) return false;
      if (encloses(*glass.surfaces, body, there)) return true;
    }
    return false;
  }

  // Each pair once for all images.
  void tell(int object, int body) {
    if (object == body || !c_.parts.told_in_glass.insert({object, body}).second) return;
    const Thing thing = object_thing(c_, object);
    c_.values.diagnostics.warning(
        c_.values.description.span(thing.place),
        thing.name + " is in the glass of " + beside(c_, object_thing(c_, body), thing) +
            " as the camera sees it, and moves relative to it",
        "what is in glass must be at rest in its frame: where that is seen, rendering ends with an error");
  }

  Compilation& c_;
};

}  // namespace

void check_camera_in_glass(Compilation& c) {
  for_each_glass(c.scene,
                 [&](const SceneFrame& frame, int surface) { check_camera_against(c, frame, surface); });
}

void warn_of_matter_in_glass(Compilation& c) {
  MatterInGlass matter(c);
  for_each_glass(c.scene, [&](const SceneFrame& frame, int surface) { matter.look_into(frame, surface); });
}

}  // namespace backlight
