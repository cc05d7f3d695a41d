// One camera ray, and what it is in every frame.
#pragma once

#include <vector>

#include "backlight/spacetime/frame.h"
#include "backlight/trace/hub.h"

namespace backlight {

/// A ray of the camera: from its event, displaced by `offset` (an eye of a stereo pair; zero otherwise),
/// back along the past light cone in the looking direction.
struct CameraRay {
  Vec3 direction{0.0, 0.0, 1.0};  ///< unit, camera frame
  Displacement<Camera> offset;    ///< simultaneous with the exposure in the camera's frame
  bool displaced = false;         ///< whether offset is not zero
  bool light_delay = true;        ///< false: simultaneous in the camera's frame instead of light-like
};

/// The ray in one frame: events (time; origin) + λ (time_rate; direction), λ > 0 the same in every frame.
struct RestRayEvents {
  Vec3 origin{0.0};
  Vec3 direction{0.0};
  double time = 0.0;
  double time_rate = -1.0;  ///< -1/D on the light cone; docs/physics.md equation (4)

  [[nodiscard]] Event<Rest> at(double lambda) const {
    return {time + lambda * time_rate, origin + lambda * direction};
  }
  /// D on the way to the camera; 1 where no light travels (light_delay = false).
  [[nodiscard]] DopplerFactor<Camera, Rest> doppler(bool light_delay) const {
    return {light_delay ? -1.0 / time_rate : 1.0};
  }
};

/// The ray in this frame: one boost.
RestRayEvents in_frame(const FrameView& frame, const CameraRay& ray);

}  // namespace backlight
