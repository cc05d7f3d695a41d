// The least model that an image needs: what must be computed for it, and what need not be.
#pragma once

#include <cstddef>
#include <string>

#include "backlight/scene/scene.h"

namespace backlight {

/// What tracing an image takes. Counts are of what is in use.
struct Needs {
  std::size_t frames = 0;         ///< distinct rest frames with surfaces: boosts for each camera ray
  std::size_t moving_frames = 0;  ///< those that move relative to the camera
  std::size_t objects = 0;
  std::size_t surfaces = 0;  ///< copies counted
  std::size_t lights = 0;
  std::size_t textures = 0;  ///< distinct images
  std::size_t stars = 0;
  bool shadow_rays = false;  ///< there are a surface and a light that casts shadows

  /// Whether colours shift anywhere in the image, so that spectra are carried instead of red, green and blue.
  bool spectral = false;
  std::string why;  ///< a clause: "'tram' moves relative to the camera", "nothing moves relative to anything"
  int wavelengths = 0;      ///< of the spectral quadrature; 0 when not spectral
  std::string why_so_many;  ///< a clause about their number; empty when not spectral
};

Needs needs_of(const Scene& scene);

}  // namespace backlight
