#include "bounding_tree.h"

#include <algorithm>
#include <numeric>

namespace backlight {
namespace {

constexpr int bins = 16;

double half_area(const AxisBox& box) {
  const Vec3 size = box.hi - box.lo;
  return size.x < 0.0 ? 0.0 : size.x * size.y + size.y * size.z + size.z * size.x;
}

/// Half the sum of the two faces each, to stay finite for large boxes.
double centre(const AxisBox& box, int axis) {
  return 0.5 * box.lo[axis] + 0.5 * box.hi[axis];
}

struct Bin {
  AxisBox box;
  int count = 0;

  void include(const Bin& other) {
    box.include(other.box);
    count += other.count;
  }
};

/// The bins of one axis between the extreme centres `low` and `high`.
struct Binning {
  double low;
  double high;

  /// Halves, whose differences are finite for centres of either sign; halving changes no digit.
  [[nodiscard]] int bin(double centre) const {
    const double part = (0.5 * centre - 0.5 * low) / (0.5 * high - 0.5 * low);
    return std::min(bins - 1, static_cast<int>(bins * part));
  }
};

struct BestSplit {
  double cost;  // expected tests: boxes' areas times counts
  int after_bin = -1;
};

BestSplit best_split(const Bin (&bin)[bins]) {
  double area_below[bins];
  int count_below[bins];
  Bin below;
  for (int i = 0; i < bins; ++i) {
    below.include(bin[i]);
    area_below[i] = half_area(below.box);
    count_below[i] = below.count;
  }
  BestSplit best{std::numeric_limits<double>::infinity(), -1};
  Bin above;
  for (int i = bins - 1; i > 0; --i) {
    above.include(bin[i]);
    const double cost = area_below[i - 1] * count_below[i - 1] + half_area(above.box) * above.count;
    if (count_below[i - 1] > 0 && above.count > 0 && cost < best.cost) {
      best = {cost, i - 1};
    }
  }
  return best;
}

}  // namespace

BoundingTree::BoundingTree(const std::vector<AxisBox>& boxes) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(boxes.size() + 1);
  split(boxes, 0, static_cast<int>(boxes.size()), 0);
}

void BoundingTree::split(const std::vector<AxisBox>& boxes, int first, int last, int depth) {
  const std::size_t here = nodes_.size();
  Node node{{}, first, last - first, 0};
  for (int k = first; k < last; ++k) {
    node.box.include(boxes[static_cast<std::size_t>(order_[static_cast<std::size_t>(k)])]);
  }
  nodes_.push_back(node);
  if (last - first <= leaf_size) {
    return;
  }
  int axis = 0;
  const int middle = partition(boxes, first, last, depth, axis);
  split(boxes, first, middle, depth + 1);
  nodes_[here].first = static_cast<std::int32_t>(nodes_.size());
  nodes_[here].count = 0;
  nodes_[here].axis = axis;
  split(boxes, middle, last, depth + 1);
}

/// Reorders [first, last) into two non-empty parts and returns where the second begins.
int BoundingTree::partition(const std::vector<AxisBox>& boxes, int first, int last, int depth, int& axis) {
  const auto box_of = [&](int surface) -> const AxisBox& { return boxes[static_cast<std::size_t>(surface)]; };
  const auto begin = order_.begin() + first;
  const auto end = order_.begin() + last;
  Vec3 low{1e308};
  Vec3 high{-1e308};
  for (auto k = begin; k != end; ++k) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], centre(box_of(*k), i));
      high[i] = std::max(high[i], centre(box_of(*k), i));
    }
  }
  BestSplit best{std::numeric_limits<double>::infinity(), -1};
  for (int i = 0; i < 3 && depth < cost_depth; ++i) {
    if (!(high[i] > low[i])) {
      continue;
    }
    const Binning binning{low[i], high[i]};
    Bin bin[bins];
    for (auto k = begin; k != end; ++k) {
      bin[binning.bin(centre(box_of(*k), i))].include({box_of(*k), 1});
    }
    const BestSplit candidate = best_split(bin);
    if (candidate.cost < best.cost) {
      best = candidate;
      axis = i;
    }
  }
  if (best.after_bin >= 0) {
    const Binning binning{low[axis], high[axis]};
    const auto middle = std::stable_partition(
        begin, end, [&](int k) { return binning.bin(centre(box_of(k), axis)) <= best.after_bin; });
    return static_cast<int>(middle - order_.begin());
  }
  // All centres coincide (or the tree is deep): halves, in file order.
  return first + (last - first) / 2;
}

}  // namespace backlight
