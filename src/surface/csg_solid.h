// A tree of solids, flattened for the search: leaves in the order of the text, and operations that know who
// they are part of.
#pragma once

#include <vector>

#include "backlight/surface/solid.h"
#include "placed_surface.h"

namespace backlight {

class Solid {
 public:
  struct Node {
    SolidOperation operation;
    int parent;  ///< -1: the whole
    bool first;  ///< whether it is the first part of its parent
    int parts;
  };
  struct Leaf {
    PlacedSurface surface;  ///< placed within the whole
    double reach;           ///< outside of this sphere about its position nothing is inside; may be infinite
    int parent;
    bool first;
    bool subtracted;  ///< an odd number of times: its outside is the inside of the whole
    int member;
  };

  explicit Solid(const SolidTree& tree);

  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  [[nodiscard]] const std::vector<Leaf>& leaves() const { return leaves_; }
  /// Leaves that move as one, each of such leaves in one group; all are placed alike within the whole.
  [[nodiscard]] const std::vector<std::vector<int>>& moving_groups() const { return moving_groups_; }
  /// Encloses the solid, in its local coordinates; infinite where it has no bounds, empty where its parts'
  /// bounds exclude each other.
  [[nodiscard]] const AxisBox& box() const { return box_; }

 private:
  AxisBox add(const SolidTree& tree, const Placement& outer, int parent, bool first, bool subtracted);

  void find_moving_groups();

  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
  std::vector<std::vector<int>> moving_groups_;
  AxisBox box_;
};

}  // namespace backlight
