// Formulas whose `t` is a clock of the thing's own.
#pragma once

#include "values.h"

namespace backlight {

/// The formula as it stands in a place whose `t` is not the image's: a function of `t` alone, or of x, y, z
/// and t if it is of formula_variables(). Parameters that use `t` are formulas in it; all other variables
/// have the image's values. Its text is the expression's.
Expression in_own_time(const ImageValues& values, const Expression& expression);

/// A number as such a formula of `t`.
Expression constant_formula(double value);

}  // namespace backlight
