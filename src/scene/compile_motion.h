// Objects whose position, rotate or scale depend on t, and so move: docs/physics.md section 10.
#pragma once

#include <memory>
#include <vector>

#include "backlight/surface/solid.h"
#include "compile_parts.h"

namespace backlight {

/// Whether an object, or a part of it, or a light moves in its frame: it has a rocket, or a formula of its
/// place depends on t, and it has no velocity besides.
bool is_in_motion(const TableView& thing);

/// The path of a lamp in the scene's frame of index `frame`; null when it is wrong, which has then been
/// reported.
std::shared_ptr<const MatterMotion> path_of(Compilation& c, const TableView& light, int frame);

/// Reports what a thing with this velocity of its own says of its motion besides.
void check_motions_apart(const TableView& thing, const ExtendedVec3& celerity);

/// A surface that moves, with its placement in the frame, but for an offset.
struct MovingShape {
  Shape shape;
  Placement placement;
  bool proved_anywhere = true;  ///< to be slower than light at all times, so that it is the same elsewhere
};

/// The object whose shape at the image's time is `shape`, in motion in the scene's frame of index `frame`:
/// `offset` is to be added to its position. Nothing when it cannot move so, which has then been reported.
std::optional<MovingShape> put_in_motion(Compilation& c, const TableView& object, int frame,
                                         const Shape& shape, const SolidTree* solid, const Vec3& offset);

}  // namespace backlight
