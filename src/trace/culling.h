// The thresholds between ways of culling. All were measured on fields of spheres of 10 to 10,000, with their
// own velocities or sharing 1, 8 or 64 frames.
#pragma once

#include <cstddef>

namespace backlight {

/// A frame with more surfaces than this has its shadow rays walk its tree, one by one, instead of having each
/// surface's cone on the light's sky looked at.
inline constexpr std::size_t tree_from = 64;

/// A frame with more surfaces than this that are asked one ray at a time (boxes, cones, cylinders) has its
/// rays walk its tree, from the camera too.
inline constexpr std::size_t camera_tree_from = 8;

/// With fewer occluders than this, each sheet of points looks at all of them; with more a tile lists first
/// what may shade anything of it.
inline constexpr std::size_t tile_list_from = 48;

/// From so many on, the shadow rays of a tile are sorted into packets, each with a list of its own. (Their
/// points are found twice for it: some 4 ms of an image of 720x526.)
inline constexpr std::size_t packets_from = 1500;

}  // namespace backlight
