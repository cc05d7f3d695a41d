// Whether a stretch of a line over which rounding hides the sign of a formula holds a root
// (docs/implicit.md).
#pragma once

#include "implicit_roots.h"

namespace backlight {

/// What is asked of f about places on one line that searches can divide no further.
class RootEvidence {
 public:
  RootEvidence(const ImplicitFormula& f, const FormulaLine& line) : f_(f), line_(line) {}

  /// Lengths below this say nothing new about a point: the rounding of its coordinates.
  [[nodiscard]] double resolution(double s) const;

  /// A cell in which f is not continuous is divided to this length. On a line all but parallel to a jump, it
  /// is long.
  [[nodiscard]] double resolution_of_jumps() const;

  /// Whether f is too small for doubles all over a long stretch: what it is there is not known.
  [[nodiscard]] bool vanishes(double from, double to) const;

  /// Whether f is 0 on [from, to], or nearly so: it comes down to its own rounding there, continuously. At an
  /// edge of its domain, a pole or a jump it does not, however wide its bounds beside that are.
  [[nodiscard]] bool comes_to_zero(double from, double to) const;

  /// Whether f leaves zero at `end` of a stretch of this length as at a face: at once, not little by little
  /// as about a double root. `side`: -1 before it, 1 behind it.
  [[nodiscard]] bool leaves_at_once(double end, int side, double length) const;

  /// Whether f is not much further from zero at the second place than at the first.
  [[nodiscard]] bool rises_slowly(double from, double to) const;

  /// Whether f goes straight through zero on [from, to], though it has a kink there: of a certain slope on
  /// either side, with the same sign.
  [[nodiscard]] bool goes_through(double from, double to) const;

 private:
  enum class Side { broken, level, falling };

  [[nodiscard]] Interval at_double(double s) const;
  [[nodiscard]] Interval over(double from, double to) const;
  [[nodiscard]] Side beside(double end, int side, double length, double least) const;
  [[nodiscard]] bool is_steady(double from, double to, int& sign) const;
  [[nodiscard]] bool matters(std::size_t variable) const;

  const ImplicitFormula& f_;
  const FormulaLine& line_;
};

}  // namespace backlight
