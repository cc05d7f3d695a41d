// Where along lines surfaces of formulas can be.
#pragma once

#include <span>

#include "body_lanes.h"
#include "convex.h"
#include "implicit_roots.h"
#include "shape_table.h"

namespace backlight {

/// Whether the bounds of an implicit shape go along a path in local coordinates.
bool goes_away(const Shape& shape);

/// The part of a line within the bounds of an implicit shape, with the faces.
Stretch inside_bounds(const Shape& shape, const LocalLine& line);

/// The line as a formula of x, y, z and t has it.
FormulaLine formula_line(const Shape& shape, const LocalLine& line);

/// Parts of lines outside of which there is nothing of each of some implicit shapes: their bounds, or less.
/// Of several, all have motions with boxes that have their coordinates in common. A face of the bounds that
/// happens to be a surface is not lost by rounding. What is found of a line does not depend on the others.
void find_stretches(std::span<const Shape* const> shapes, const LocalLines& lines,
                    std::span<LineStretches> found);

}  // namespace backlight
