// How the light of one lamp arrives at one point of a surface: docs/physics.md section 4.
#pragma once

#include <optional>

#include "backlight/trace/visibility.h"

namespace backlight {

/// A point of a surface that the camera sees, in the surface's rest frame.
struct SeenPoint {
  FirstHit hit;
  SurfacePoint surface;
  Vec3 normal{0.0};          ///< unit, on the side that is seen
  Vec3 to_camera{0.0};       ///< unit, where the ray came from, as aberrated into this frame
  double proper_time = 0.0;  ///< the object's frame time of the emission event
};

/// The point where this ray meets a surface.
SeenPoint seen_point(const Hub& hub, RayInFrames& rays, const FirstHit& hit);

/// One lamp's light at a seen point, before it is known whether something is in the way.
struct Arrival {
  DopplerFactor<Rest, Source> doppler;  ///< frequency at the surface over frequency at the lamp
  double gamma = 1.0;                   ///< of the lamp's velocity relative to the surface
  double emission_time = 0.0;           ///< the lamp's own time when this light left it (times c)
  double cosine = 0.0;                  ///< of the angle of incidence, in the surface's frame; > 0
  double inverse_square = 1.0;          ///< 1/r², r the length of the null segment in the surface's frame
  Vec3 to_light{0.0};                   ///< unit, in the surface's frame
  ShadowSegment segment;
};

/// The light of a point or distant lamp at `point`; empty when it shines on the other side of the surface.
std::optional<Arrival> arrival(const Hub& hub, RayInFrames& rays, const SeenPoint& point,
                               const LightView& light);

}  // namespace backlight
