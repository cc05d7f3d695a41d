// What a ray meets first, and whether a lamp is hidden.
#pragma once

#include <cstdint>
#include <vector>

#include "backlight/surface/surface_set.h"
#include "backlight/trace/ray.h"

namespace backlight {

/// The first surface back along a ray.
struct FirstHit {
  Hit hit;             ///< its λ counts from `start`
  int frame = -1;      ///< index of the surface's rest frame
  double start = 0.0;  ///< λ from which the ray met it in that frame
  Extended lambda;     ///< of the ray as a whole
  [[nodiscard]] bool found() const { return hit.found(); }
};

/// The object that a surface of a frame belongs to.
const Object& object_of(const Scene& scene, int frame, int surface);

/// The object whose surface was hit.
const Object& object_of(const Scene& scene, const FirstHit& hit);

/// The material there: index into Scene::materials. `point`: where the surface was hit.
int material_of(const Scene& scene, const FirstHit& hit, const SurfacePoint& point);

/// A camera ray in all frames that it was asked for: one per thread, used again for every ray.
///
/// first_hit() asks for all frames with surfaces; any other frame is boosted when first asked for.
class RayInFrames {
 public:
  explicit RayInFrames(const Hub& hub)
      : camera_(&hub), hub_(&hub), events_(hub.frames.size()), age_(hub.frames.size(), 0) {}

  void start(const CameraRay& ray) { start(*camera_, ray); }
  /// A ray of another hub of the same scene.
  void start(const Hub& hub, const CameraRay& ray) {
    hub_ = &hub;
    ray_ = ray;
    ++current_;
  }
  [[nodiscard]] const CameraRay& ray() const { return ray_; }

  /// The ray in frame `index`.
  const RestRayEvents& in(int index) {
    const auto i = static_cast<std::size_t>(index);
    if (age_[i] != current_) {
      events_[i] = in_frame(hub_->frames[i], ray_);
      age_[i] = current_;
    }
    return events_[i];
  }

  /// The ray in the frame of a hit, begun where it met that: so it is from now on what in() gives.
  const RestRayEvents& in_frame_of(const FirstHit& hit) {
    const auto i = static_cast<std::size_t>(hit.frame);
    if (in(hit.frame).start != hit.start) events_[i] = in_frame_from(hub_->frames[i], ray_, hit.start);
    return events_[i];
  }

  /// The ray's event at λ, in frame `index`.
  Event<Rest> event(int index, const Extended& lambda) {
    const FrameView& frame = hub_->frames[static_cast<std::size_t>(index)];
    if (!frame.far) return in(index).at(lambda);
    const ExtendedEvent event = far_event(*frame.far, ray_, lambda);
    return {double(event.t), event.x.rounded()};
  }

 private:
  const Hub* camera_;
  const Hub* hub_;
  CameraRay ray_;
  std::vector<RestRayEvents> events_;
  std::vector<std::uint64_t> age_;
  std::uint64_t current_ = 0;
};

/// The first hit in one frame (of hub.occupied) at a λ below `limit`.
FirstHit first_hit_in(int frame, const Hub& hub, RayInFrames& rays, double limit);

/// The nearest hit over all frames: the smallest λ, compared across frames as it stands
/// (docs/physics.md section 2); of equal λ, the frame that comes first.
FirstHit first_hit(const Hub& hub, RayInFrames& rays);

/// The way from a lit point to a light, in the light's frame: a past-directed null segment that starts at
/// the hit and ends (at parameter 1) at the emission event, or goes on forever to a distant light.
struct ShadowSegment {
  NullDirection<Source> direction;
  Vec3 start_in_surface_frame{0.0};  ///< the lit point, moved off its surface by the bound of its error
  Vec3 direction_in_surface_frame{0.0};
  RayClock clock_in_surface_frame;
  double end = 1.0;
};

/// Whether something is between the hit and the light: docs/physics.md equation (11). Tested in each
/// occluder's own frame, at the retarded times by construction.
/// The part of it that one frame has (one of hub.occupied).
bool is_shadowed_in(int frame, const Hub& hub, RayInFrames& rays, const FirstHit& hit, const LightView& light,
                    const ShadowSegment& segment);

/// The same over all frames.
bool is_shadowed(const Hub& hub, RayInFrames& rays, const FirstHit& hit, const LightView& light,
                 const ShadowSegment& segment);

}  // namespace backlight
