// Point lamps that light nothing, because an opaque object is all around them or they lie on its surface.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "things.h"

namespace backlight {
namespace {

// An opening that all of these directions miss is no more than some 6 degrees across.
constexpr int direction_count = 512;

// Spread evenly over the sphere: equal steps in height, turned by the golden angle each.
Vec3 direction(int i) {
  const double height = 1.0 - (2.0 * i + 1.0) / direction_count;
  const double across = std::sqrt(1.0 - height * height);
  const double turn = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
  return {across * std::cos(turn), height, across * std::sin(turn)};
}

template <class Blocked>
bool all_ways(const Blocked& blocked) {
  for (int i = 0; i < direction_count; ++i) {
    if (!blocked(direction(i))) return false;
  }
  return true;
}

// Whether this one surface is all around the point. Asked of rays, so that it holds of what is closed by its
// walls alone (a hollow shell) and not of what the bounds of a formula leave open (a lampshade).
bool encloses(const SurfaceSet& surfaces, int surface, const Vec3& point, const RayClock& clock) {
  const BoundingSphere ball = surfaces.bounds(surface);
  if (glm::length(point - ball.centre) > ball.radius) return false;
  return all_ways(
      [&](const Vec3& way) { return surfaces.first_crossing_of(surface, point, way, clock).found(); });
}

// Whether a surface passes no farther than `near` from the point, as `crosses(start, way, length)` finds on
// three lines through it.
template <class Crosses>
bool passes_by(const Vec3& point, double near, const Crosses& crosses) {
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 way{0.0};
    way[axis] = 1.0;
    if (crosses(point - near * way, way, 2.0 * near)) return true;
  }
  return false;
}

class HiddenLamps {
 public:
  explicit HiddenLamps(Compilation& c) : c_(c) {}

  void run() {
    for (std::size_t i = 0; i < c_.scene.lights.size(); ++i) {
      const Light& light = c_.scene.lights[i];
      if (light.kind == LightKind::point && light.shadows && !light.motion) look_around(i, light);
    }
  }

 private:
  // A frame that moves relative to the lamp has it inside of something for a while only, and what it lit
  // before and after is seen: nothing is said of that.
  void look_around(std::size_t index, const Light& light) {
    const InertialFrame& own = c_.scene.frames[static_cast<std::size_t>(light.frame)].motion;
    for (const SceneFrame& frame : c_.scene.frames) {
      const bool moves = frame.motion.celerity != own.celerity || frame.surfaces->any_moves();
      if (frame.surfaces->size() == 0 || moves) continue;
      const ExtendedVec3 apart = to_frame(frame.motion, own.origin).x;
      look_around_in(frame, index, frame.motion == own ? light.position : light.position + apart.rounded());
    }
  }

  void look_around_in(const SceneFrame& frame, std::size_t light, const Vec3& lamp) {
    const SurfaceSet& surfaces = *frame.surfaces;
    const ExtendedEvent exposure = to_frame(frame.motion, c_.scene.camera.event);
    const RayClock clock{double(exposure.t), 0.0};
    const Vec3 camera = exposure.x.rounded();
    const double near = 1e-12 * (glm::length(lamp) + glm::length(camera - lamp));
    const bool touches = passes_by(lamp, near, [&](const Vec3& start, const Vec3& way, double length) {
      return surfaces.blocked(start, way, length, clock);
    });
    if (!touches && !all_ways([&](const Vec3& way) {
          return surfaces.blocked(lamp, way, std::numeric_limits<double>::infinity(), clock);
        })) {
      return;
    }
    for (int s = 0; s < static_cast<int>(surfaces.size()); ++s) {
      if (!surfaces.casts_shadow(s)) continue;
      if (touches) {
        const bool here = passes_by(lamp, near, [&](const Vec3& start, const Vec3& way, double length) {
          return surfaces.first_crossing_of(s, start, way, clock).lambda < length;
        });
        if (here) return warn_of_contact(light, object_of(frame, s));
      } else if (encloses(surfaces, s, lamp, clock) && !encloses(surfaces, s, camera, clock)) {
        return warn_of_enclosure(light, object_of(frame, s));
      }
    }
  }

  static int object_of(const SceneFrame& frame, int surface) {
    return frame.object_of_surface[static_cast<std::size_t>(surface)];
  }

  void warn(std::size_t light, int object, const std::string& before, const std::string& after,
            std::string hint) {
    const Thing lamp = light_thing(c_, light);
    c_.values.diagnostics.warning(c_.values.description.span(lamp.place),
                                  lamp.name + before + beside(c_, object_thing(c_, object), lamp) + after,
                                  std::move(hint));
  }

  void warn_of_enclosure(std::size_t light, int object) {
    warn(light, object, " is inside ", ", which hides it from all that the camera sees",
         "write casts_shadow = false for the object, or shadows = false for the light");
  }

  void warn_of_contact(std::size_t light, int object) {
    warn(light, object, " lies on the surface of ", ": rounding decides whether that hides it",
         "move it off the surface, or write casts_shadow = false for the object");
  }

  Compilation& c_;
};

}  // namespace

void warn_of_hidden_lamps(Compilation& c) {
  HiddenLamps(c).run();
}

}  // namespace backlight
