// How the light of one lamp arrives at one point of a surface: docs/physics.md section 4.
#pragma once

#include <optional>

#include "backlight/trace/visibility.h"

namespace backlight {

/// A point of a surface that the camera sees. What its matter reflects is told in the matter's own frame:
/// that of the surface or, of matter that is not at rest there, the one that goes along with it
/// (docs/physics.md section 10), along the same axes.
struct SeenPoint {
  FirstHit hit;
  SurfacePoint surface;                 ///< in the surface's frame
  LorentzTransform<Rest, Rest> matter;  ///< from the surface's frame to the matter's
  Vec3 side{0.0};                       ///< the surface's normal in its frame, on the side that is seen
  Vec3 normal{0.0};                     ///< unit, on the side that is seen
  Vec3 to_camera{0.0};                  ///< unit, where the ray came from
  double doppler = 1.0;      ///< on the way to the camera: frequency in the surface's frame over the matter's
  double time = 0.0;         ///< the surface's frame time of the emission event
  double proper_time = 0.0;  ///< the matter's own: the same, unless it moves in the frame
};

/// γ of the matter relative to where `to_surface` comes from.
template <class From>
double gamma_between(const SeenPoint& point, const LorentzTransform<Rest, From>& to_surface) {
  if (point.matter.is_identity()) return to_surface.gamma();
  const Vec3& w = to_surface.celerity();
  return to_surface.gamma() * point.matter.gamma() +
         glm::dot(to_surface.is_rotated() ? to_surface.rotation() * w : w, point.matter.celerity());
}

/// The point where this ray meets a surface.
SeenPoint seen_point(const Hub& hub, RayInFrames& rays, const FirstHit& hit);

/// When a lamp on a path sent the light that arrives at an event: docs/physics.md equation (29). All in the
/// lamp's base frame. A lamp that was as fast as light ever longer ago, as a rocket's was, has not lit some
/// events yet.
struct LampMoment {
  NullDirection<Source> direction;  ///< from the event to the lamp; of no length: it has not lit it yet
  double time = 0.0;
  Vec3 velocity{0.0};  ///< the lamp's

  /// Of `direction` in the frame of the lamp's velocity.
  [[nodiscard]] double own_length() const;
  /// Its light's direction in that frame, of any length.
  [[nodiscard]] Vec3 leaving() const;
  /// By which its strength goes: its own time, if that matters.
  [[nodiscard]] double strength_time(const Light& light) const;
};
LampMoment way_to_moving(const Light& light, const Vec3& place, double event_time);

/// One lamp's light at a seen point, before it is known whether something is in the way.
struct Arrival {
  DopplerFactor<Rest, Source> doppler;  ///< frequency at the surface over frequency at the lamp
  double gamma = 1.0;                   ///< of the lamp's velocity relative to the matter
  double emission_time = 0.0;           ///< the lamp's own time when this light left it (times c)
  double share = 1.0;                   ///< of a spot lamp's strength, that leaves in this direction; > 0
  double cosine = 0.0;                  ///< of the angle of incidence, in the surface's frame; > 0
  double inverse_square = 1.0;          ///< 1/r², r the length of the null segment in the surface's frame
  Vec3 to_light{0.0};                   ///< unit, in the surface's frame
  ShadowSegment segment;
};

/// The light of a point or distant lamp at `point`; empty when it shines on the other side of the surface.
std::optional<Arrival> arrival(const Hub& hub, RayInFrames& rays, const SeenPoint& point,
                               const LightView& light);

}  // namespace backlight
