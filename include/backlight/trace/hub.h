// The hub: every frame relative to the camera's event, composed once an image. Rays that a mirror passes on
// have one of their own (relays.h), for which its frame stands in the camera's place.
//
// docs/physics.md section 6. A ray costs one boost of a direction per frame, a hit in a frame is
// camera_event + λ k there, and no number of a ray ever goes through world coordinates: clocks of 10⁹ and
// frames of γ = 10⁶ then cost nothing.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "backlight/base/shared_vector.h"
#include "backlight/scene/scene.h"
#include "backlight/spacetime/transform.h"

namespace backlight {

/// What a frame of large relative γ needs besides: there, the camera's event may be γ times farther from the
/// frame's surfaces than the light travels, and rays are brought next to them in extended precision.
struct FarView {
  ExtendedTransform from_camera;
  ExtendedTransform from_world;
  ExtendedEvent camera_event;
  BoundingSphere bounds;       ///< of those surfaces of the frame that have bounds
  std::vector<int> unbounded;  ///< the others: rays are brought next to where they meet each
};

/// One frame of the scene as the camera's event has it.
struct FrameView {
  LorentzTransform<Rest, Camera> from_camera;
  Event<Rest> camera_event;  ///< the exposure, in the frame's coordinates
  const SceneFrame* scene = nullptr;
  /// For γ > robust_gamma, where there are surfaces or lights, and of the world; else null: there may be many
  /// frames.
  std::shared_ptr<const FarView> far;
};

/// Pieces of the model that are left out for nothing but to measure what they are for, and cost
/// (docs/speed-accuracy.md).
struct ModelPieces {
  /// False: a light's shadows are those of one moment of its own frame, as if light took no time to the
  /// surface.
  bool retarded_shadows = true;
  /// False: frames of large γ are treated as all others (spacetime/transform.h).
  bool robust_arithmetic = true;
};

/// One light's rest frame, and the way from it to every frame of the scene.
struct LightView {
  const Light* light = nullptr;
  std::vector<LorentzTransform<Rest, Source>> to_frame;  ///< by frame index
  std::optional<ExtendedTransform> to_world;             ///< none: the light is at rest there
  bool retarded_shadows = true;                          ///< as of ModelPieces
};

/// All of them, for one camera event.
struct Hub {
  std::vector<FrameView> frames;                   ///< by frame index; [0] is the world
  SharedVector<LightView> lights;                  ///< by light index
  std::vector<int> occupied;                       ///< indices of frames with surfaces, ascending
  Search search = Search::tree;                    ///< how single rays look through surfaces
  LorentzTransform<Camera, Rest> camera_from_sky;  ///< for what shines forward from infinity: the stars
};

/// From where a hub is seen: the camera's celerity and event in the world, or those of a frame that passes
/// light on.
struct Viewpoint {
  ExtendedVec3 celerity;
  ExtendedEvent event;
};

/// Composes the camera's hub in extended precision.
Hub make_hub(const Scene& scene, const ModelPieces& pieces = {}, Search search = Search::tree);

/// The hub of another viewpoint of the same scene: it shares the lights of `camera`.
Hub make_hub(const Scene& scene, const Hub& camera, const Viewpoint& viewpoint, const ModelPieces& pieces);

}  // namespace backlight
