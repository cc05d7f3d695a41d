// What the searches for first roots over lanes have in common, and each of them but the one by intervals.
#pragma once

#include "implicit_roots.h"

namespace backlight {

/// search_roots() by reduced affine forms. Each line's root is found by the same steps, whichever lines it is
/// searched with.
void search_by_forms(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<Root> roots,
                     RootsWanted wanted, RootWork& work);

/// The same for formulas that have a LineProgram::degree(). A line on which rounding hides too much is
/// searched by forms.
void search_polynomials(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<Root> roots,
                        RootsWanted wanted, RootWork& work);

/// The signs of f where the pieces begin, as far as they are certain.
void find_signs(const ImplicitFormula& f, std::span<const LinePiece> pieces, std::span<int> signs);

/// A root that is enclosed, on its way to full precision: the index of its piece, and its
/// NewtonBracket::bend.
struct Settling {
  std::size_t piece;
  double bend = std::numeric_limits<double>::infinity();
};

/// Newton's steps for some of the roots, each on its piece, from its t on.
void settle_roots(const LineProgram& program, std::span<const LinePiece> pieces,
                  std::span<const Settling> some, std::span<Root> roots, RootWork& work);

}  // namespace backlight
