// The search for the first roots along many lines on which the formula is a polynomial of low degree.
//
// The tape is run once for each line, in the arithmetic of polynomials with a bound of all rounding
// (expression/line_polynomials.h); where their roots are is found without it (polynomial_lanes.h). The places
// are settled by Newton's steps of the formula itself.
#pragma once

#include <span>

#include "implicit_roots.h"

namespace backlight {

/// first_roots() (implicit_roots.h) in this way, for formulas that have a LineProgram::degree(). A line on
/// which rounding hides too much is searched by forms. Each line's root is found by the same steps, whichever
/// lines it is searched with.
void first_roots_of_polynomials(const ImplicitFormula& f, std::span<const LinePiece> pieces,
                                std::span<Root> roots, RootsWanted wanted, RootWork& work);

}  // namespace backlight
