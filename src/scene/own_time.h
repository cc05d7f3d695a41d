// Formulas whose `t` is a clock of the thing's own.
#pragma once

#include <span>

#include "backlight/expression/compose.h"
#include "values.h"

namespace backlight {

/// The formula as it stands in a place whose `t` is not the image's: a function of `t` alone, or of x, y, z
/// and t if it is of formula_variables(). Parameters that use `t` are formulas in it; all other variables
/// have the image's values. Its text is the expression's.
Expression in_own_time(const ImageValues& values, const Expression& expression);

/// The same as a node of `composer`. `coordinates`: the nodes for x, y and z, if it is of them; `t`: the one
/// for the time.
Composer::Node insert_in_own_time(Composer& composer, const ImageValues& values, const Expression& expression,
                                  std::span<const Composer::Node> coordinates, Composer::Node t);

/// A number as such a formula of `t`.
Expression constant_formula(double value);

}  // namespace backlight
