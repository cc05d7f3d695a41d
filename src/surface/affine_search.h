// The search for the first roots along many lines by reduced affine forms (expression/affine.h).
//
// A form over a piece of the line says where in it zeros can be, and the sign of f before and behind. So most
// pieces are left behind whole or for the greatest part without looking at any point, and a simple root is
// enclosed closer and closer. Whether it is one, bounds on the slope say, over the little that is left.
#pragma once

#include <span>

#include "implicit_roots.h"

namespace backlight {

/// first_roots() (implicit_roots.h) in this way. Each line's root is found by the same steps, whichever lines
/// it is searched with.
void first_roots_by_forms(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<Root> roots,
                          RootsWanted wanted, RootWork& work);

}  // namespace backlight
