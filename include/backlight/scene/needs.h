// The least model that an image needs: what must be computed for it, and what need not be.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "backlight/scene/scene.h"

namespace backlight {

/// Surfaces of one shape, whose crossings are all found in one way.
struct RootSearch {
  ShapeKind shape = ShapeKind::sphere;
  std::string how;  ///< root_finding() of surface/shape.h
  std::size_t surfaces = 0;
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
  std::string why;  ///< a clause: "'tram' moves relative to the camera", "nothing moves relative to anything"
  int wavelengths = 0;      ///< at which reflectances are sampled; 0 when not spectral
  std::string why_so_many;  ///< a clause about their number; empty when not spectral
};

Needs needs_of(const Scene& scene);

/// "200 spheres: closed form; 1 torus: quartic".
std::string in_words(const std::vector<RootSearch>& roots);

}  // namespace backlight
