// The first crossings of a solid along many lines at once.
#pragma once

#include <span>

#include "csg_sweep.h"
#include "local_lines.h"

namespace backlight {

/// The first crossing of the whole on each line beyond lambda_min, at t = infinity where there is none. What
/// its formulas are asked along all lines is answered together; what is found of a line does not depend on
/// the others.
void first_of_solid(const Solid& solid, const LocalLines& lines, double lambda_min,
                    std::span<Sweep::Event> first);

}  // namespace backlight
