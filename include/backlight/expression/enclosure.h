// Certain bounds on an expression: its tape run on intervals that are rounded outwards.
//
// The interval holds the values of the expression's real function, as if computed without rounding, for all
// values of the variables in their intervals, and so also what Expression::evaluate returns for them. The
// functions set the rounding mode of the processor and put it back before they return.
#pragma once

#include <span>

#include "backlight/expression/interval.h"
#include "backlight/expression/tape.h"

namespace backlight {

/// A straight line in the space of the variables: variable i is origin[i] + s direction[i].
struct VariableLine {
  std::span<const double> origin;
  std::span<const double> direction;
};

/// The values over a box. `variables` holds what the tape's variables index.
Interval enclose(const Tape& tape, std::span<const Interval> variables);

/// The values at one point of a line.
Interval enclose(const Tape& tape, const VariableLine& line, double s);

/// The values, and the derivatives with respect to s, for s in [from, to].
IntervalSlope enclose(const Tape& tape, const VariableLine& line, double from, double to);

}  // namespace backlight
