// The least model that an image needs: what must be computed for it, and what need not be.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "backlight/scene/scene.h"

namespace backlight {

/// Surfaces of one shape, whose crossings are all found in one way.
struct RootSearch {
  ShapeKind shape = ShapeKind::sphere;
  RootFinder finder = RootFinder::closed_form;
  std::string how;  ///< root_finding() of surface/shape.h
  std::size_t surfaces = 0;
};

/// Why colours shift in an image, or why they do not.
enum class ModelReason {
  background_moves,  ///< relative to the camera
  object_moves,      ///< relative to the camera
  light_moves,       ///< relative to an object
  mirror_moves,      ///< relative to what it shows
  only_stars_shift,  ///< whose colours are found once an image
  nothing_moves,
  effects_off  ///< something moves, and the effects show no shift of colours
};

/// Why reflectances are known at so many wavelengths.
enum class WavelengthReason {
  none,       ///< colours do not shift
  given,      ///< by the scene or the command line
  usual,      ///< the default
  tolerance,  ///< the fewest that are within the tolerance
};

/// What tracing an image takes. Counts are of what is in use.
struct Needs {
  std::size_t frames = 0;           ///< distinct rest frames with surfaces: boosts for each camera ray
  std::size_t moving_frames = 0;    ///< those that move relative to the camera
  std::size_t extended_frames = 0;  ///< of those, the ones that need more than double: γ > robust_gamma
  std::size_t objects = 0;
  std::size_t surfaces = 0;       ///< copies counted
  std::vector<RootSearch> roots;  ///< of all surfaces, in the order of the frames
  std::size_t lights = 0;
  std::size_t shadowing_lights = 0;  ///< for which shadow rays are traced
  std::size_t textures = 0;          ///< distinct images, for which alone OpenImageIO is loaded
  std::size_t stars = 0;
  bool shadow_rays = false;  ///< there are a surface and a light that casts shadows

  /// Whether colours shift anywhere in the image, so that spectra are carried instead of red, green and blue.
  bool spectral = false;
  ModelReason reason = ModelReason::nothing_moves;
  std::string why;      ///< the reason in words: "object 'tram' moves relative to the camera", "nothing moves
                        ///< relative to anything"
  int wavelengths = 0;  ///< at which reflectances are sampled; 0 when not spectral
  WavelengthReason wavelength_reason = WavelengthReason::none;
  std::string why_so_many;  ///< a clause about their number; empty when not spectral
};

Needs needs_of(const Scene& scene);

/// Names for programs, which stay: "object-moves", "nothing-moves"...
std::string_view code_of(ModelReason reason);
/// "given", "default", "tolerance"; "none" where colours do not shift.
std::string_view code_of(WavelengthReason reason);
/// "closed-form", "quartic", "interval", "polynomial", "affine", "csg".
std::string_view code_of(RootFinder finder);

/// "200 spheres: closed form; 1 torus: quartic".
std::string in_words(const std::vector<RootSearch>& roots);

}  // namespace backlight
