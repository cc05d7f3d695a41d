// Things that are small on the camera's sky: where the image has them.
#pragma once

#include <vector>

#include "backlight/camera/projection.h"
#include "backlight/trace/hub.h"

namespace backlight {

/// A part of one pixel of the image that holds all that a small thing shows there, or holds it nearly.
struct SmallThing {
  int x = 0;  ///< pixel of the full image
  int y = 0;
  double x0 = 0.0, y0 = 0.0, x1 = 1.0, y1 = 1.0;  ///< in units of that pixel, 0 ... 1
  ImagePoint centre;                              ///< of the thing's outline, as far as it is on the image
};

/// Those of all surfaces whose ball is no more than two pixels across as this eye sees it (-1, 0, +1 as for
/// camera_ray()), hidden or not, in the order of the pixels: rows, from the upper left. From the cones of
/// docs/physics.md section 8, where light is delayed and where it is not. Things without bounds are not
/// small; nor, however far away, is what reaches across the seam of an image of all directions.
std::vector<SmallThing> small_things(const Scene& scene, const Hub& hub, int eye);

}  // namespace backlight
