// Frames that pass light on: where a ray goes from a mirror.
//
// docs/physics.md section 11. A mirror's frame stands in the camera's place: from an event of it every other
// frame is composed in extended precision, once an image, and a ray that is passed on starts from there. The
// world is no stop.
#pragma once

#include <memory>
#include <vector>

#include "backlight/trace/illumination.h"

namespace backlight {

/// A frame with mirrors or glass.
struct Relay {
  Hub hub;              ///< about `event`, of the frame
  ExtendedEvent event;  ///< in the frame's coordinates: near its surfaces as the camera sees them
  LorentzTransform<Camera, Rest> to_camera;
  /// By frame index, of those that are relays: the time, in that frame, of this one's event since its own.
  std::vector<double> since_relay;
};

/// All of one image; none in a scene without mirrors and glass, which pays nothing for them.
class Relays {
 public:
  Relays() = default;
  Relays(const Scene& scene, const Hub& camera, const ModelPieces& pieces);

  [[nodiscard]] bool any() const { return !relays_.empty(); }
  /// That of a frame whose surfaces pass light on.
  [[nodiscard]] const Relay& of(int frame) const { return *relays_[static_cast<std::size_t>(frame)]; }

  /// The event at which a ray meets a surface of such a frame, since that frame's relay event; `from`: the
  /// relay that the ray comes from, or null for the camera. `place`: in the coordinates of the frame.
  [[nodiscard]] Displacement<Camera> since(const Relay* from, const RayInFrames& rays, const FirstHit& hit,
                                           const Vec3& place) const;

 private:
  std::vector<std::unique_ptr<const Relay>> relays_;  // by frame index; null where nothing is passed on
  std::vector<double> camera_since_relay_;
  const Hub* camera_ = nullptr;
};

/// Whether some surface of the scene passes light on.
bool passes_light_on(const Scene& scene);

}  // namespace backlight
