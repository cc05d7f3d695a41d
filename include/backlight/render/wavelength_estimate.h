// How many wavelengths carry an image's colours where an error is asked for instead of their number.
#pragma once

#include "backlight/scene/needs.h"
#include "backlight/scene/scene.h"

namespace backlight {

/// What needs_of() says, with the wavelengths that meet the film's tolerance: the fewest for which no ray of
/// a grid over the whole image is off by more than half of it, on the scale of shown_value() and as a share
/// of its own brightness; the other half is the samples'. Lights, tables and lines depend on no number. What
/// is so bright or so small that the grid misses it is not looked at. Does not depend on crop or threads.
/// Where `film.wavelengths` is given, or no tolerance, nothing is traced.
Needs needs_within_tolerance(const Scene& scene);

}  // namespace backlight
