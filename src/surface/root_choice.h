// Which search for first roots a formula gets.
#pragma once

#include "implicit_roots.h"

namespace backlight {

/// What evaluations of a formula take, in units of one addition over lanes. Fixed numbers, from counting the
/// operations of the kernels: never a time.
struct EvaluationCosts {
  double piece = 0.0;       ///< bounds on f and its slope over a piece
  double point = 0.0;       ///< bounds on f at a point
  double number = 0.0;      ///< f and its slope in double precision
  double form = 0.0;        ///< an affine form over a piece
  double polynomial = 0.0;  ///< the coefficients along a line
  double part = 0.0;        ///< one look at such a polynomial in Bernstein's form
};
EvaluationCosts evaluation_costs(const LineProgram& program);

/// The cost of a search.
double cost_of(const RootWork& work, const EvaluationCosts& costs);

/// What a search does on 32 fixed lines across a box, half of them from a point inside. Lines that it would
/// leave to RootWalk are counted, and not walked.
RootWork probe(const ImplicitFormula& f, const Vec3& low, const Vec3& high, RootFinder finder);

}  // namespace backlight
