// Motions and clocks beyond the digits that frames are composed with: docs/physics.md section 6.
#include <cmath>
#include <cstdio>

#include "things.h"

namespace backlight {
namespace {

/// Frames are composed with 2^-104, and a few roundings of that.
constexpr double rounding = 2e-31;

/// Up to this relative γ what is seen is as exact as at rest (docs/accuracy.md).
constexpr double most_gamma = 1e13;

/// Of two things' Lorentz factors in the world: what their relative celerity is uncertain by is this product
/// times the rounding.
constexpr double most_product = 1e19;

/// Where the camera is in a thing's rest frame is known at least to this part of the thing's size (of a lamp,
/// of its distance), or to a rounding of what its clock shows.
constexpr double least_part = 1e-6;

std::string roughly(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

double size_of(const ExtendedEvent& event) {
  const Vec3 x = event.x.rounded();
  return std::abs(double(event.t)) + std::abs(x.x) + std::abs(x.y) + std::abs(x.z);
}

class ReachCheck {
 public:
  explicit ReachCheck(Compilation& c) : c_(c), camera_(camera_thing(c)) {
    for (const SceneFrame& frame : c.scene.frames) {
      gammas_.push_back(double(lorentz_factor(frame.motion.celerity)));
    }
  }

  void run() {
    const Scene& scene = c_.scene;
    for (std::size_t f = 0; f < scene.frames.size(); ++f) {
      const SceneFrame& frame = scene.frames[f];
      if (frame.surfaces->size() == 0) continue;
      check_camera(
          f, [&] { return frame.surfaces->bounds_of_bounded(); }, [&] { return object_in(frame); });
    }
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
      const Light& light = scene.lights[i];
      if (light.kind == LightKind::ambient) continue;
      const auto own = static_cast<std::size_t>(light.frame);
      check_camera(
          own,
          [&] {
            return BoundingSphere{light.position, 0.0};
          },
          [&] { return light_thing(c_, i); });
      for (std::size_t f = 0; f < scene.frames.size(); ++f) {
        if (scene.frames[f].surfaces->size() == 0) continue;
        check_motion(
            own, gammas_[f], scene.frames[f].motion.celerity, [&] { return light_thing(c_, i); },
            [&] { return object_in(scene.frames[f]); });
      }
    }
    if (scene.sky.emits || !scene.sky.stars.empty()) {
      check_motion(
          static_cast<std::size_t>(scene.sky.frame), camera_gamma(), scene.camera.celerity,
          [&] { return background_thing(c_); }, [&] { return camera_; });
    }
  }

 private:
  [[nodiscard]] double camera_gamma() const { return double(lorentz_factor(c_.scene.camera.celerity)); }

  [[nodiscard]] Thing object_in(const SceneFrame& frame) const {
    return object_thing(c_, frame.object_of_surface[0]);
  }

  // How a frame's thing moves against another: false, and an error, where that is too fast.
  template <class Subject, class Other>
  bool check_motion(std::size_t frame, double other_gamma, const ExtendedVec3& other, const Subject& subject,
                    const Other& other_thing) {
    const double product = gammas_[frame] * other_gamma;
    if (product < 0.4 * most_gamma) return true;  // γ of the two is at most twice that
    const ExtendedVec3& own = c_.scene.frames[frame].motion.celerity;
    if (own == other) return true;
    const double gamma = relative_motion(own, other).gamma;
    if (gamma <= most_gamma && product <= most_product) return true;
    const Thing thing = subject();
    const std::string pair = thing.name + " and " + beside(c_, other_thing(), thing);
    const bool fast = !(gamma <= most_gamma);
    error(thing, fast
                     ? pair + " move at gamma = " + roughly(gamma) +
                           " relative to each other, and images are computed up to " + roughly(most_gamma)
                     : "how " + pair + " move relative to each other cannot be computed: their own gammas, " +
                           roughly(gammas_[frame]) + " and " + roughly(other_gamma) +
                           ", multiply to more than " + roughly(most_product));
    return false;
  }

  template <class Bounds, class Subject>
  void check_camera(std::size_t frame, const Bounds& bounds_of, const Subject& subject) {
    const CameraView& camera = c_.scene.camera;
    const InertialFrame& motion = c_.scene.frames[frame].motion;
    if (!check_motion(frame, camera_gamma(), camera.celerity, subject, [&] { return camera_; })) return;
    const double doubt = rounding * gammas_[frame] * (size_of(camera.event) + size_of(motion.origin));
    const ExtendedEvent event = to_frame(motion, camera.event);
    if (doubt <= 1e-15 * size_of(event)) return;
    const BoundingSphere bounds = bounds_of();
    const double size = bounds.radius > 0.0 ? bounds.radius : glm::length(event.x.rounded() - bounds.centre);
    if (doubt <= least_part * size) return;
    const Thing thing = subject();
    error(thing, "where " + beside(c_, camera_, thing) + " is in the rest frame of " + thing.name +
                     " cannot be computed: at gamma = " + roughly(gammas_[frame]) +
                     " and world coordinates of " + roughly(size_of(camera.event)) + ", 32 digits leave " +
                     roughly(doubt) + " of doubt");
  }

  void error(const Thing& thing, std::string message) {
    c_.values.diagnostics.error(c_.values.description.span(thing.place), std::move(message),
                                "tell the scene from the frame of one of its fast things, or nearer to the "
                                "origin");
  }

  Compilation& c_;
  Thing camera_;
  std::vector<double> gammas_;  // in the world, by frame
};

}  // namespace

void check_reach(Compilation& c) {
  ReachCheck(c).run();
}

}  // namespace backlight
