// A tree of axis-aligned boxes (a bounding volume hierarchy) over the bounded surfaces of one frame, eight to
// a node: as many as the lanes of any machine look at together.
#pragma once

#include <cstdint>
#include <vector>

#include "placed_surface.h"

namespace backlight {

struct WideNode {
  static constexpr int width = 8;
  alignas(64) double lo[3][width];
  alignas(64) double hi[3][width];  ///< below lo: there is no such child
  std::int32_t child[width];        ///< index of a node; or ~ that of a surface
};

/// The nodes of a tree over `boxes`, at least one; the first one is the root. Split by the surface area
/// heuristic (16 bins an axis), in halves where that does not help.
std::vector<WideNode> wide_tree(const std::vector<AxisBox>& boxes);

}  // namespace backlight
