// Where a line crosses the surface of a shape, all in local coordinates.
#pragma once

#include "backlight/surface/shape.h"
#include "local_line.h"

namespace backlight {

/// A crossing at line.at(t).
struct Crossing {
  double t = 0.0;
  int part = 0;
};

/// Ordered by t. A closed surface is crossed inwards and outwards in turn; a line that only touches counts as
/// crossing twice at the same t, or not at all, as rounding decides.
struct Crossings {
  int count = 0;
  Crossing list[4];

  void add(double t, int part) { list[count++] = {t, part}; }
};

/// Which crossings are wanted. `first`: solvers may leave out those with λ <= lambda_min, and those behind
/// the first of the others; what they do report is the same to the last bit. `all`: the whole line.
enum class Wanted { first, all };

Crossings crossings(const Shape& shape, const LocalLine& line, double lambda_min, Wanted wanted);

/// The quartic (src/surface/torus.cpp).
Crossings torus_crossings(double major, double minor, const LocalLine& line, double lambda_min,
                          Wanted wanted);

}  // namespace backlight
