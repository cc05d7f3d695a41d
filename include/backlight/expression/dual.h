// A value together with its derivative along one direction (forward differentiation).
#pragma once

namespace backlight {

/// value + derivative·ε with ε² = 0. Give the variable x the derivative 1 and all others 0, and an
/// expression's derivative is d/dx. Arithmetic on it is not overloaded: the table of operations holds every
/// derivative.
struct Dual {
  double value = 0.0;
  double derivative = 0.0;
};

}  // namespace backlight
