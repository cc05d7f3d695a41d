// The shapes of objects, and of the parts of which solids are made.
#pragma once

#include <optional>
#include <vector>

#include "backlight/surface/solid.h"
#include "compile_parts.h"

namespace backlight {

/// A surface, and the materials of its members where it has more than one.
struct CompiledShape {
  Shape shape;
  std::vector<int> member_materials;  ///< by SurfacePoint::member; empty: that of the object
  std::optional<SolidTree> solid;     ///< what `shape` was made of, if of several
  Vec3 centre{0.0};                   ///< of a mesh: where its origin is in the object's coordinates
};

/// The shape of an object whose own material is `material`; nothing when something is wrong with it, which
/// has then been reported.
std::optional<CompiledShape> compile_shape(Compilation& c, const TableView& object, Materials& materials,
                                           int material);

/// `position`, `rotate` and `scale`.
Vec3 read_scale(const TableView& table);

}  // namespace backlight
