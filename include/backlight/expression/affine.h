// Reduced affine arithmetic: an expression over a piece of a line as a straight line with a certain error.
//
// A form stands for centre + slope·ε ± error, where ε in [-1, 1] is the same symbol for all parts of the
// expression: the place on the piece. So x - x is 0 here, which intervals do not see; what is not linear goes
// into the error, which shrinks as the square of the piece. All is rounded outwards (docs/implicit.md).
#pragma once

#include "backlight/expression/enclosure.h"
#include "backlight/expression/interval.h"
#include "backlight/expression/tape.h"

namespace backlight {

/// The values of an expression for all ε in [-1, 1] lie within centre + slope ε ± error. The error is
/// infinite where nothing is known; nothing else is ever infinite or not a number.
struct AffineForm {
  double centre = 0.0;
  double slope = 0.0;
  double error = 0.0;
  Continuity continuity = Continuity::continuous;
};

/// What a form says about the zeros of an expression on [from, to].
struct ZeroRegion {
  /// No zero is outside [first, last], which is within [from, to]. Empty (first > last): no zero at all.
  double first = 0.0;
  double last = 0.0;
  /// The certain sign in front of `first`, if that is beyond `from`; behind `last`, if that is before `to`,
  /// it is the opposite. Where there is no zero: the sign all over the piece.
  int sign = 0;
  Continuity continuity = Continuity::continuous;

  [[nodiscard]] bool empty() const { return first > last; }
};

/// The form for s in [from, to] of the line: at ε = ±1, s is not inside the piece.
AffineForm enclose_affine(const Tape& tape, const VariableLine& line, double from, double to);

/// Where the form leaves room for zeros.
ZeroRegion enclose_zeros(const Tape& tape, const VariableLine& line, double from, double to);

}  // namespace backlight
