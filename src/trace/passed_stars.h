// Stars in mirrors and through glass: docs/physics.md section 11, equation (33a).
#pragma once

#include <functional>
#include <vector>

#include "backlight/colour/observer.h"
#include "backlight/trace/hub.h"
#include "escape.h"
#include "sheet.h"

namespace backlight {

/// Finds the images that mirrors and glass make of stars. A way through them maps the film to the sky, and a
/// star's image is where it leads to the star: Newton's steps find it, from cells of the film whose corners
/// and centre go the same way.
class PassedStars {
 public:
  /// All ways of the ray through an image point that end at infinity; or that by one route, if there is it.
  using Trace = std::function<std::vector<Escape>(const ImagePoint&, const Effects&, const Route* only)>;

  /// The scene and the wavelengths must outlive it. `everywhere`: light is passed on wherever the camera
  /// looks, as it is in glass.
  PassedStars(const Scene& scene, const Hub& hub, const WavelengthSet& wavelengths, bool everywhere);

  /// What those in pixel (x, y) of the full image add to its radiance, for one eye; it depends on nothing
  /// else.
  [[nodiscard]] LinearRgb in_pixel(int x, int y, int eye, const Trace& trace) const;

 private:
  friend class PixelSearch;
  [[nodiscard]] LinearRgb colour(const Star& star, const Escape& way) const;
  [[nodiscard]] LinearRgb about_colour(const Star& star, const Escape& way) const;
  /// Of a blackbody of unit luminance.
  [[nodiscard]] LinearRgb colour_of(const Spectrum& unit, const Star& star, const Escape& way) const;
  void add_cones(const FrameView& view, const std::vector<int>& surfaces);
  [[nodiscard]] bool may_be_passed_on(int x, int y, int eye) const;

  const Scene* scene_;
  const WavelengthSet* wavelengths_;
  std::vector<int> by_height_;    // the stars' numbers, ascending in the y of their directions
  std::vector<Spectrum> bodies_;  // blackbodies of unit luminance, of temperatures in equal ratios...
  double coldest_ = 1.0;          // ...from this on
  bool everywhere_;
  // Around what passes light on, of each frame that has such, where light is delayed and where not; of the
  // one eye or the left one, and of the right one.
  std::vector<LaneCone> cones_[2];
};

}  // namespace backlight
