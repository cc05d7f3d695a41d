// A binary tree of axis-aligned boxes (a bounding volume hierarchy) over the bounded surfaces of one frame.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "backlight/base/vector.h"
#include "local_line.h"
#include "placed_surface.h"

namespace backlight {

class BoundingTree {
 public:
  /// Splits by the surface area heuristic (16 bins an axis), in halves where that does not help. Reorders
  /// nothing itself: order()[k] is which box stands at place k of the search order.
  explicit BoundingTree(const std::vector<AxisBox>& boxes);

  [[nodiscard]] const std::vector<int>& order() const { return order_; }

  /// Calls visit(first, last) for the leaves (ranges of the search order) that the ray may meet at some λ in
  /// [0, limit()], near ones first; limit() is asked anew each time, and visit returns true to stop. A leaf
  /// entered at exactly limit() is still visited, so that ties can be decided by index.
  template <class Limit, class Visit>
  void walk(const RestRay& ray, const Limit& limit, const Visit& visit) const;

 private:
  struct Node {
    AxisBox box;
    std::int32_t
        first;  // leaf: place in the search order; else: index of the second child (the first follows)
    std::int32_t count;  // leaf: how many; else 0
    std::int32_t axis;
  };
  // Splits are by cost down to this depth, and by halves below it: 2^31 surfaces still fit the stack.
  static constexpr int cost_depth = 60;
  static constexpr int stack_size = 96;
  static constexpr int leaf_size = 4;

  void split(const std::vector<AxisBox>& boxes, int first, int last, int depth);
  int partition(const std::vector<AxisBox>& boxes, int first, int last, int depth, int& axis);

  std::vector<Node> nodes_;
  std::vector<int> order_;
};

/// The λ at which the ray enters the box, or infinity if it misses; both ends are widened by more than the
/// rounding of the three operations behind them, so that no hit inside is lost.
inline double entry(const AxisBox& box, const RestRay& ray, const Vec3& inverse) {
  constexpr double widening = 1e-15;
  double in = 0.0;
  double out = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const bool forwards = !std::signbit(inverse[i]);
    const double near = ((forwards ? box.lo[i] : box.hi[i]) - ray.origin[i]) * inverse[i];
    const double far = ((forwards ? box.hi[i] : box.lo[i]) - ray.origin[i]) * inverse[i];
    const double near_early = near - widening * std::abs(near);
    const double far_late = far + widening * std::abs(far);
    // 0 · infinity (the ray lies in the face) is not a number, compares false, and so excludes nothing.
    in = near_early > in ? near_early : in;
    out = far_late < out ? far_late : out;
  }
  return in <= out ? in : std::numeric_limits<double>::infinity();
}

template <class Limit, class Visit>
void BoundingTree::walk(const RestRay& ray, const Limit& limit, const Visit& visit) const {
  struct Pending {
    std::int32_t node;
    double entry;
  };
  const Vec3 inverse = 1.0 / ray.direction;
  Pending stack[stack_size];
  int pending = 0;
  std::int32_t current = 0;
  double current_entry = entry(nodes_[0].box, ray, inverse);
  constexpr double never = std::numeric_limits<double>::infinity();
  while (true) {
    const bool wanted = current_entry < never && current_entry <= limit();
    const Node& node = nodes_[static_cast<std::size_t>(current)];
    if (wanted && node.count == 0) {
      std::int32_t near = current + 1;
      std::int32_t far = node.first;
      double near_entry = entry(nodes_[static_cast<std::size_t>(near)].box, ray, inverse);
      double far_entry = entry(nodes_[static_cast<std::size_t>(far)].box, ray, inverse);
      if (far_entry < near_entry || (far_entry == near_entry && ray.direction[node.axis] < 0.0)) {
        std::swap(near, far);
        std::swap(near_entry, far_entry);
      }
      if (far_entry < never) {
        stack[pending++] = {far, far_entry};
      }
      current = near;
      current_entry = near_entry;
      continue;
    }
    if (wanted &&
        visit(static_cast<std::size_t>(node.first), static_cast<std::size_t>(node.first + node.count))) {
      return;
    }
    if (pending == 0) {
      return;
    }
    current = stack[--pending].node;
    current_entry = stack[pending].entry;
  }
}

}  // namespace backlight
