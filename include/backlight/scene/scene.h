// The scene as it is true at one image: what the tracer reads. Made by scene/compile.h.
//
// Units: lengths in scene units, times multiplied by c (so c = 1), angles in radians, celerities
// dimensionless. Colours are linear Rec.709 beside their spectra.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "backlight/base/shared_vector.h"
#include "backlight/camera/projection.h"
#include "backlight/colour/brightness.h"
#include "backlight/colour/rgb.h"
#include "backlight/colour/spectrum.h"
#include "backlight/expression/expression.h"
#include "backlight/film/texture.h"
#include "backlight/spacetime/transform.h"
#include "backlight/surface/matter_motion.h"
#include "backlight/surface/surface_set.h"

namespace backlight {

/// The relativistic effects to show. The defaults are nature's.
struct Effects {
  bool light_delay = true;
  bool doppler = true;            ///< the shift of colours
  BrightnessSwitches brightness;  ///< the searchlight effect, factor by factor
  friend bool operator==(const Effects&, const Effects&) = default;

  /// The searchlight factors on the way to the camera: none where no light travels (light_delay = false).
  [[nodiscard]] const BrightnessSwitches& towards_camera() const {
    return light_delay ? brightness : no_searchlight;
  }
};

/// Other effects in a part of the image. x, y are fractions of the full image, y down; the last region that
/// contains a sample's point wins.
struct EffectsRegion {
  double x0 = 0.0, y0 = 0.0, x1 = 1.0, y1 = 1.0;
  Effects effects;
};

/// A colour with its spectrum: `rgb` is the film colour of `spectrum` seen at rest (for a reflectance, under
/// D65).
struct Colour {
  Spectrum spectrum;
  LinearRgb rgb{0.0};
};

/// A pattern of two reflectances over the texture coordinates.
struct Checker {
  std::array<Colour, 2> colours;
  double size = 1.0;  ///< edge of a square, in units of the texture coordinates
};

/// What of a material runs by the matter's own time (docs/physics.md equation (9b)): formulas of t in scene
/// seconds, among which constants stand for what does not. scene/material_in_time.h evaluates them.
struct ReflectanceInTime {
  using Rgb = std::array<Expression, 3>;
  std::array<Rgb, 2> colours;  ///< the second of a checker; none of a texture, which has levels alone
  std::optional<Expression> uv, ir;
};
struct LobeInTime {
  Expression specular, shininess;
};
/// A blackbody's, or a colour's, or else a multiple of Material::emission.
struct EmissionInTime {
  Expression strength;
  double exposure = 1.0;  ///< that of the film, if Material::emission does not have it
  std::optional<Expression> temperature;
  bool absolute = false;
  std::optional<ReflectanceInTime::Rgb> colour;
};
struct MaterialInTime {
  std::optional<ReflectanceInTime> reflectance;
  std::optional<LobeInTime> lobe;
  std::optional<EmissionInTime> emission;
};

/// What light goes through, at rest.
struct Glass {
  double index = 1.0;   ///< of refraction, at all wavelengths
  Colour tint;          ///< the share of light that a way of length 1 leaves
  bool tinted = false;  ///< not 1
};

/// What a surface is made of, in its rest frame. A scene may have a hundred thousand: what few of them have
/// is behind a pointer.
struct Material {
  std::string name;
  Colour reflectance;                      ///< Lambert, when there is neither texture nor checker
  std::shared_ptr<const Texture> texture;  ///< reflectance from an image, or null
  std::optional<double> uv;  ///< of a texture: level at 300 nm and below, see Spectrum::reflectance
  std::optional<double> ir;  ///< of a texture: level at 890 nm and above
  std::shared_ptr<const Checker> checker;  ///< or null
  double specular = 0.0;                   ///< Phong: the share of the light reflected by the lobe
  double shininess = 50.0;                 ///< Phong: the lobe's exponent
  std::shared_ptr<const Colour> emission;  ///< own radiance, at rest to itself; null: it emits nothing
  std::shared_ptr<const Colour> mirror;    ///< the share of light that is reflected as by a mirror, or null
  std::shared_ptr<const Glass> glass;      ///< what is within its surfaces; null: it is opaque
  std::shared_ptr<const MaterialInTime> in_time;  ///< null: nothing of it changes
};

/// Whether what comes in is passed on, besides what the material shows of its own.
inline bool passes_on(const Material& material) {
  return material.mirror != nullptr || material.glass != nullptr;
}

/// Whether a material shows anything of its own: it reflects diffusely, or with a lobe, or emits.
bool has_own_light(const Material& material);

enum class LightKind { point, distant, ambient };

/// The axis of a lamp that turns, of any length: formulas of its own time t in scene seconds.
struct TurningAxis {
  std::array<Expression, 3> components;
  double c = 1.0;  ///< of the scene
};

/// What of a point light's directions a spot lamp shines into: those within a cone, in the lamp's own frame,
/// whose axes are its base frame's carried by the pure boost.
struct SpotCone {
  Vec3 axis{0.0, -1.0, 0.0};                   ///< unit, of its light
  std::shared_ptr<const TurningAxis> turning;  ///< null: it does not turn, and `axis` is it
  double half_angle = 0.5;                     ///< in (0, pi]; beyond it is dark
  double edge = 0.0;  ///< 0..1: the share of that angle over which the light fades, at its end

  /// The share of the full intensity that leaves along `direction`, of any length, at the lamp's own time
  /// (times c): 1 up to (1 - edge) of the angle, then s²(3 - 2s) of what is left of the edge (docs/physics.md
  /// equation (12a)). None while a turning axis is zero.
  [[nodiscard]] double share(const Vec3& direction, double own_time) const;
};

/// A light in its rest frame.
struct Light {
  LightKind kind = LightKind::point;
  std::string name;
  int frame = 0;       ///< index of its rest frame
  Vec3 position{0.0};  ///< point: in that frame's coordinates
  /// Point: of a lamp on a path, whose world line is that of the origin of the motion's ball; null: at rest.
  std::shared_ptr<const MatterMotion> motion;
  std::optional<SpotCone> cone;    ///< point: it shines into this alone
  Vec3 direction{0.0, -1.0, 0.0};  ///< distant: the unit direction in which the light travels, in that frame
  Colour colour;                   ///< spectrum of unit strength
  /// Strength as a function of the light's own (frame) time: intensity of a point light, irradiance of a
  /// distant one; radiance of an ambient one, by the time of the surface's frame. `strength` when it does not
  /// depend on time; when it does, the formula is divided by it.
  double strength = 1.0;
  bool shadows = true;  ///< whether what is in its way hides it; an ambient light's never does
  bool flickers = false;
  bool tells_time = false;  ///< the data channels want its own time, though its strength may not depend on it
  Expression strength_of_time;  ///< of t in scene seconds, when it flickers

  /// Whether anybody asks for its own time.
  [[nodiscard]] bool has_clock() const { return flickers || tells_time || (cone && cone->turning); }
};

/// Whether shadow rays are traced for it.
inline bool throws_shadows(const Light& light) {
  return light.shadows && light.kind != LightKind::ambient;
}

/// A star: a point at infinity, given in the sky's frame.
struct Star {
  Vec3 direction{0.0, 0.0, 1.0};  ///< unit, where it is seen by an observer at rest in the sky's frame
  double temperature = 6500.0;    ///< kelvin, of the blackbody it is
  double illuminance = 0.0;       ///< at rest, relative to a star of magnitude 0; times Sky::star_scale, the
                                  ///< film-Y irradiance (film Y times steradians)
};

/// What is at infinity behind everything, at rest in its own frame.
struct Sky {
  int frame = 0;
  bool given = false;  ///< the scene has one, be it black: rays that meet nothing see it
  bool emits = false;
  Colour radiance;                         ///< uniform: colour or blackbody
  std::shared_ptr<const Texture> texture;  ///< equirectangular, in the frame's axes, or null
  double texture_scale = 1.0;
  SharedVector<Star> stars;
  double star_scale = 1.0;  ///< on their illuminance
};

/// One object of the file. Copies made by `repeat` share it.
struct Object {
  std::string name;
  int id = 0;                         ///< 1, 2, ... in file order
  int material = 0;                   ///< index into Scene::materials
  std::vector<int> member_materials;  ///< of a solid made of several: by SurfacePoint::member
  bool casts_shadow = true;           ///< of glass: takes its share of lamps' light
};

/// One inertial frame with all that is at rest in it.
/// What a surface takes while its frame's search tree is made, about.
inline constexpr std::uint64_t bytes_of_surface = 900;

/// Copies of a surface that were counted and not made (ImageRequest::outline).
struct CopiesLeftOut {
  int surface = 0;  ///< of the frame
  std::size_t copies = 0;
};

struct SceneFrame {
  std::string name;  ///< as in the file; empty for a frame made by a thing's own velocity
  InertialFrame motion;
  /// Never null. Images in which it is the same share it.
  std::shared_ptr<const SurfaceSet> surfaces = std::make_shared<const SurfaceSet>();
  SharedVector<int> object_of_surface;  ///< index into Scene::objects, by surface index
  std::vector<CopiesLeftOut> left_out;  ///< empty in a scene that is rendered

  /// How many surfaces there are, with those that were left out.
  [[nodiscard]] std::size_t surface_count() const {
    std::size_t count = object_of_surface.size();
    for (const CopiesLeftOut& left : left_out) count += left.copies;
    return count;
  }
};

struct Stereo {
  double separation = 0.065;  ///< distance of the two eyes, in scene units, along the camera's right
};

/// The camera during one exposure.
struct CameraView {
  std::string name;
  ExtendedVec3 celerity;     ///< in the world
  ExtendedEvent event;       ///< the exposure: world coordinates
  double proper_time = 0.0;  ///< the camera's own time of it (times c)
  Lens lens;
  std::optional<Stereo> stereo;
};

/// No pixel gets more samples where their number is chosen.
inline constexpr int most_adaptive_samples = 4096;

/// What the film asks for.
struct FilmSettings {
  int width = 720;
  int height = 526;
  int samples = 1;  ///< of each pixel; at most, if `adaptive`
  unsigned seed = 0;
  std::vector<std::string> aovs;  ///< of: Z doppler emissionTime properTime P N objectId light samples
  double tolerance =
      0.0;  ///< root mean square error asked for, on the scale of shown_value(); 0: none asked for
  bool adaptive = false;  ///< the samples of each pixel are chosen to meet `tolerance`
  int wavelengths = 0;    ///< where colours shift; 0: for the program to choose
  double exposure = 1.0;  ///< on all film values; the colours of the scene's lights have it already
  int bounces = 8;        ///< how often the light of a ray is passed on at most
};

/// What was made for an image, and what it took over from images before, unchanged.
struct CompileCounts {
  std::size_t surfaces_made = 0;  ///< evaluated, placed, and put into search trees
  std::size_t surfaces_reused = 0;
  std::size_t materials_made = 0;
  std::size_t materials_reused = 0;
};

struct Scene {
  double time = 0.0;   ///< t of the image, in scene seconds: what expressions see
  double frame = 1.0;  ///< number of the image in the animation; not whole for a time between two of them
  /// Those of [params] by name, with their values at the image's time, as far as they are finite.
  std::vector<std::pair<std::string, double>> parameters;
  double c = 1.0;                  ///< scene units of length per second; divides reported times
  std::vector<SceneFrame> frames;  ///< distinct frames; [0] is the world
  SharedVector<Object> objects;
  SharedVector<Material> materials;
  std::vector<Light> lights;
  Sky sky;
  CameraView camera;
  Effects effects;
  std::vector<EffectsRegion> regions;
  FilmSettings film;
  CompileCounts counts;
};

/// Whether matter of the object, or of an object of the frame, passes light on.
bool passes_on(const Scene& scene, const Object& object);
bool passes_on(const Scene& scene, const SceneFrame& frame);

/// Whether the film asks for this of `aovs`.
bool has_aov(const Scene& scene, std::string_view name);

/// The effects in force at an image point (pixels of the full image).
const Effects& effects_at(const Scene& scene, const ImagePoint& point);

}  // namespace backlight
