// Solids made of solids (constructive solid geometry).
#pragma once

#include <vector>

#include "backlight/surface/placement.h"
#include "backlight/surface/shape.h"

namespace backlight {

/// `difference`: the first part without the others.
enum class SolidOperation { unite, intersect, difference };

/// A tree of solids: a shape where it has no parts, and else an operation on its parts. Each is placed within
/// the one that it is part of.
///
/// The boundary of the whole is where a line goes from its inside to its outside or back. Faces of two parts
/// that coincide, to within the error bounds of their points, are one event: what counts is whether the line
/// is inside before both and after both. So solids that touch are glued without a wall between them, a part
/// that ends flush with what it is subtracted from leaves no skin, and solids that only touch have no common
/// part. Of coincident faces the part that was written first gives material and texture coordinates.
struct SolidTree {
  Shape shape;          ///< without parts
  Placement placement;  ///< of the shape, or of the parts together
  SolidOperation operation = SolidOperation::unite;
  std::vector<SolidTree> parts;
  int member = 0;  ///< of a shape: what SurfacePoint::member says where it is hit
};

/// Operations nested deeper than this are refused.
inline constexpr int deepest_solid = 64;

/// What is wrong with the tree, or an empty text: an operation on nothing, nesting too deep, a shape that
/// encloses nothing (a disk) or that is itself made by csg(); and what is wrong with its shapes and
/// placements.
std::string problem(const SolidTree& tree);

/// The boundary of a solid for which problem() is empty. Its normals point outward, on the walls of what was
/// subtracted too; texture coordinates are those of the part that was hit.
Shape csg(const SolidTree& tree);

}  // namespace backlight
