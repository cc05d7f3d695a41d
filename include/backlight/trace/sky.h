// What comes from infinity: docs/physics.md section 7.
#pragma once

#include <vector>

#include "backlight/colour/observer.h"
#include "backlight/trace/shading.h"

namespace backlight {

/// Of its texture.
LinearRgb sky_texel(const Sky& sky, double u, double v);

/// Radiance of the sky in its own frame along this ray, as a film colour.
Radiance<Rest> sky_radiance(const Sky& sky, const RestRayEvents& ray);

/// The same with scratch.shift on the way.
LinearRgb sky_shifted(const ShadingContext& context, const Radiance<Rest>& radiance, Scratch& scratch);

/// Film colour of a star's irradiance, `body` at rest, with its colours shifted so and under filters: the
/// density per unit wavelength is in it, the factor on the flux is not.
LinearRgb star_colour(const Spectrum& body, DopplerFactor<Camera, Rest> shift,
                      const std::vector<Filter>& filters, const WavelengthSet& wavelengths);

/// About the greatest film value of a star in a pixel of the picture's middle, by whatever way its light
/// comes.
double brightest_star(const Scene& scene, const FrameView& sky, const WavelengthSet& wavelengths);

/// A star as the camera has it.
struct StarImage {
  int x = 0;  ///< pixel of the full image
  int y = 0;
  Vec3 direction{0.0};      ///< unit, camera frame: for the test whether an object hides it
  LinearRgb radiance{0.0};  ///< its light spread over that pixel
  bool light_delay = true;  ///< as in the effects in force where it is seen
};

/// All stars that fall on the film, by row and then column: aberrated forward, shifted as the blackbodies
/// they are, flux by D².
std::vector<StarImage> star_images(const Scene& scene, const Hub& hub, const WavelengthSet& wavelengths);

}  // namespace backlight
