// One camera ray, and what it is in every frame.
#pragma once

#include <vector>

#include "backlight/spacetime/frame.h"
#include "backlight/surface/ray_clock.h"
#include "backlight/trace/hub.h"

namespace backlight {

/// A ray of the camera: from its event, displaced by `offset` (an eye of a stereo pair; zero otherwise),
/// back along the past light cone in the looking direction. Or one that a mirror or glass passed on: then
/// what is said here of the camera and its frame is to be said of a relay (relays.h) and the mirror's.
struct CameraRay {
  Vec3 direction{0.0, 0.0, 1.0};  ///< unit, camera frame
  Displacement<Camera> offset;    ///< simultaneous with the exposure in the camera's frame
  bool displaced = false;         ///< whether offset is not zero
  bool light_delay = true;        ///< false: simultaneous in the camera's frame instead of light-like
  /// |direction|: of a ray that was passed on, in the frame that passed it on, 1/D from there to the camera.
  double length = 1.0;
  double index = 1.0;  ///< of refraction of what it goes through: time runs so much faster than length
};

/// The ray in one frame: events (time; origin) + (λ - start) (time_rate; direction), λ > 0 the same in every
/// frame.
struct RestRayEvents {
  Vec3 origin{0.0};
  Vec3 direction{0.0};
  double time = 0.0;
  double time_rate = -1.0;  ///< -1/D on the light cone; docs/physics.md equation (4)
  double start = 0.0;       ///< λ of `origin`: 0, the camera's event, unless the ray was brought nearer
  double index = 1.0;       ///< as of CameraRay

  [[nodiscard]] Event<Rest> at(const Extended& lambda) const {
    const double step = double(lambda - Extended(start));
    return {time + step * time_rate, origin + step * direction};
  }
  /// The frame's time by λ - start.
  [[nodiscard]] RayClock clock() const { return {time, time_rate}; }
  /// D on the way to the camera; 1 where no light travels (light_delay = false).
  [[nodiscard]] DopplerFactor<Camera, Rest> doppler(bool light_delay) const {
    return {light_delay ? -index / time_rate : 1.0};
  }
};

/// The ray in this frame: one boost. In a frame of large γ it starts where it comes near the surfaces that
/// have bounds.
RestRayEvents in_frame(const FrameView& frame, const CameraRay& ray);

/// The ray in this frame, which has a FarView, from the λ `start` on.
RestRayEvents in_frame_from(const FrameView& frame, const CameraRay& ray, double start);

/// λ - start where the ray enters the bounds, with room for the rounding of where that is; 0 from inside.
double start_near(const BoundingSphere& bounds, const RestRayEvents& events);

/// The ray's event at λ in this frame, which has a FarView.
ExtendedEvent far_event(const FarView& far, const CameraRay& ray, const Extended& lambda);

}  // namespace backlight
