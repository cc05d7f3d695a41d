// Where a ray that was passed on leaves the scene: docs/physics.md section 11, stars.
#pragma once

#include <cstdint>
#include <vector>

#include "backlight/colour/film_integral.h"
#include "backlight/spacetime/frame.h"

namespace backlight {

/// By which surfaces a ray was passed on, and how: the same of neighbouring rays.
using Route = std::vector<std::uint64_t>;

/// The end of one way through mirrors and glass, at infinity.
struct Escape {
  Route route;
  Vec3 direction{0.0};                ///< unit, in the sky's frame
  DopplerFactor<Camera, Rest> shift;  ///< of colours, from the sky to the camera; 1 where none are shifted
  LinearRgb factor{1.0};              ///< on radiance there, besides filters
  std::vector<Filter> filters;
};

/// What asks for the ends alone, and for no light.
struct EscapeSearch {
  const Route* only = nullptr;  ///< by this route; or null: by all
  std::vector<Escape> found = {};
  Route so_far = {};
};

}  // namespace backlight
