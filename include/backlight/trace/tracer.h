// From a camera ray to the light that it carries.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "backlight/trace/relays.h"
#include "backlight/trace/sky.h"

namespace backlight {

/// What is seen in a mirror: by the ray that goes on from it, from mirror to mirror, where that ends.
struct MirrorRecord {
  int object_id = 0;  ///< as of SurfaceRecord
  /// Light-travel distance along the whole way, camera frame; infinite where it ends at no surface
  double distance = std::numeric_limits<double>::infinity();
  double doppler = 0.0;        ///< ω_camera/ω_object
  double emission_time = 0.0;  ///< world time, scene seconds
};

/// What is known of the surface that a ray meets, as written to the EXR's data channels
/// (docs/scene-reference.md). Zero where it meets none, but for the distance and the sky's Doppler factor.
struct SurfaceRecord {
  int object_id = 0;  ///< 1, 2, ... in file order; 0 = nothing
  /// Z: light-travel distance to the hit, camera frame; infinite where there is none
  double distance = std::numeric_limits<double>::infinity();
  double doppler = 0.0;        ///< ω_camera/ω_object
  double emission_time = 0.0;  ///< world time of the emission event, scene seconds
  double proper_time = 0.0;    ///< the object's frame time of it, scene seconds
  Vec3 position{0.0};          ///< P, in the object's rest frame
  bool unresolved = false;     ///< the root could not be isolated to full precision (surface/implicit.h)
  Vec3 normal{0.0};            ///< N, facing the ray, in the object's rest frame
  int lamps = -1;              ///< lights that reach the point, own emission one of them; -1: no surface
  double unshifted = 0.0;      ///< luminance of the film colour, had no wavelength been shifted on its way
  MirrorRecord mirror;         ///< if it is a mirror, and the film has the channels
};

/// What a ray brings.
struct RayLight {
  LinearRgb colour{0.0};  ///< scene-linear film colour, stars apart
  bool opaque = false;    ///< it met a surface, or a background that the scene gives: for alpha
};

struct Contact;
struct Escape;
struct FrameBeside;
struct Leg;
struct Medium;
struct PassedOn;
class PassedStars;

/// Traces rays of one image. Immutable; each thread brings its own Scratch.
class Tracer {
 public:
  /// `wavelengths`: size of the spectral quadrature, or 0 when no colour is shifted anywhere in the image.
  /// The scene must outlive the tracer.
  Tracer(const Scene& scene, int wavelengths, const ModelPieces& pieces = {}, Search search = Search::tree);

  [[nodiscard]] Scratch make_scratch(InstructionSet set = InstructionSet::widest) const;

  /// The light along `ray`.
  RayLight light(const CameraRay& ray, const Effects& effects, Scratch& scratch) const;
  LinearRgb colour(const CameraRay& ray, const Effects& effects, Scratch& scratch) const {
    return light(ray, effects, scratch).colour;
  }

  /// The same when it is known what the ray meets first: `hit`, or nothing.
  LinearRgb colour_of(const CameraRay& ray, const FirstHit& hit, const Effects& effects,
                      Scratch& scratch) const;

  /// The light along any piece of a ray's way (leg.h), with scratch.rays begun on it.
  LinearRgb colour_of(const Leg& leg, const FirstHit& hit, const Effects& effects, Scratch& scratch) const;
  /// The first piece.
  [[nodiscard]] Leg camera_leg(const CameraRay& ray) const;

  /// What the ray meets.
  SurfaceRecord surface(const CameraRay& ray, Scratch& scratch) const;

  /// The same when it is known what that is.
  SurfaceRecord surface_of(const CameraRay& ray, const FirstHit& hit, Scratch& scratch) const;

  /// What the scene's film asks for of the data channels "light", `lamps` and `unshifted` of the record of
  /// the same ray, and "lampTime": by light, its own time when it sent what reaches the point, left as it is
  /// where it does not.
  void add_light(const CameraRay& ray, const Effects& effects, SurfaceRecord& record,
                 std::vector<double>& times, Scratch& scratch) const;

  /// The stars of pixel (x, y) of the full image that no object hides from this eye, and those that it sees
  /// there in mirrors and through glass.
  LinearRgb stars(int x, int y, int eye, Scratch& scratch) const;

  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] const Hub& hub() const { return hub_; }
  [[nodiscard]] const Relays& relays() const { return relays_; }
  [[nodiscard]] const RestColours& rest_colours() const { return rest_colours_; }
  [[nodiscard]] ShadingContext shading() const {
    return {scene_, &hub_, &rest_colours_, wavelengths_, &spectra_, glass_.get()};
  }
  /// Whether the camera is in glass: its rays are then no light rays, and not for sheets.
  [[nodiscard]] bool camera_is_in_glass() const;
  [[nodiscard]] bool is_spectral() const { return spectral_; }
  [[nodiscard]] bool has_stars() const { return !stars_.empty() || passed_stars_ != nullptr; }

 private:
  // path.cpp: the colour along a leg of a ray's way, of which it is known what it meets first.
  LinearRgb colour_along(const Leg& leg, const FirstHit& hit, const Effects& effects, bool shifted,
                         Scratch& scratch) const;
  LinearRgb colour_at(const Leg& leg, const FirstHit& hit, const Effects& effects, bool shifted,
                      Scratch& scratch) const;
  LinearRgb colour_mirrored(const PassedOn& from, const Colour& share, const Effects& effects, bool shifted,
                            Scratch& scratch) const;
  LinearRgb colour_parted(const PassedOn& from, const Glass& glass, const Effects& effects, bool shifted,
                          Scratch& scratch) const;
  std::vector<Escape> escapes(const CameraRay& ray, const Effects& effects,
                              const std::vector<std::uint64_t>* only, Scratch& scratch) const;
  bool goes_on(const Leg& leg, Scratch& scratch) const;
  LinearRgb follow(const Leg& leg, const Effects& effects, bool shifted, Scratch& scratch) const;

  // passing.cpp: how a ray goes on.
  [[nodiscard]] CameraRay in_medium(CameraRay ray) const;
  [[nodiscard]] Leg passed_on(const PassedOn& from, const Vec3& way, const Vec3& beyond,
                              const RayInFrames& rays) const;
  [[nodiscard]] Leg mirrored(const PassedOn& from, const RayInFrames& rays) const;
  [[nodiscard]] Leg refracted(const PassedOn& from, const Vec3& way, const Contact& contact,
                              const RayInFrames& rays) const;
  [[nodiscard]] Leg main_part(const PassedOn& from, const Material& material, const RayInFrames& rays) const;
  FirstHit start(const Leg& leg, Scratch& scratch) const;
  void require_rest_in_glass(const Leg& leg, const FirstHit& hit) const;
  MirrorRecord seen_in_mirror(const Leg& camera, const FirstHit& first, Scratch& scratch) const;
  [[nodiscard]] const Material& material_at(const SeenPoint& point) const;
  [[nodiscard]] const Hub& hub_of(const Leg& leg) const;
  void find_glass();

  const Scene* scene_;
  Hub hub_;
  Relays relays_;
  std::shared_ptr<const std::vector<GlassSurface>> glass_;               // of the scene
  std::shared_ptr<const std::vector<std::vector<FrameBeside>>> beside_;  // glass.h
  std::shared_ptr<const std::vector<Medium>> camera_media_;              // that the camera is in
  double faintest_ = 0.0;       // weight of what glass passes on that is still followed
  double faintest_star_ = 0.0;  // the same where stars are looked for
  RestColours rest_colours_;
  const WavelengthSet* wavelengths_;
  SceneSpectra spectra_;  // where colours are shifted
  bool spectral_;
  std::vector<StarImage> stars_;
  std::shared_ptr<const PassedStars> passed_stars_;  // where there are stars and what passes their light on
};

/// The ray through an image point (pixels of the full image); empty where the projection shows nothing.
/// `eye` is -1 for the left eye of a stereo pair, +1 for the right, 0 for the one camera.
std::optional<CameraRay> camera_ray(const CameraView& camera, const ImagePoint& point, const Effects& effects,
                                    int eye);

}  // namespace backlight
