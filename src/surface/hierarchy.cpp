#include "hierarchy.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace backlight {
namespace {

constexpr int bins = 16;
// Splits are by cost down to this depth, and by halves below it, so that the walk's stack has room.
constexpr int cost_depth = 60;

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

/// The surfaces of a node, or of a part of one: a range of the order.
struct Range {
  int first, last, depth;
  AxisBox box;
  [[nodiscard]] int count() const { return last - first; }
};

class Builder {
 public:
  explicit Builder(const std::vector<AxisBox>& boxes) : boxes_(boxes), order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0);
  }

  std::vector<WideNode> build() && {
    nodes_.reserve(boxes_.size() / 4 + 1);  // seldom are more needed: what is not is never touched
    add(range(0, static_cast<int>(boxes_.size()), 0));
    return std::move(nodes_);
  }

 private:
  [[nodiscard]] Range range(int first, int last, int depth) const {
    Range result{first, last, depth, {}};
    for (int k = first; k < last; ++k) {
      result.box.include(boxes_[static_cast<std::size_t>(order_[static_cast<std::size_t>(k)])]);
    }
    return result;
  }

  /// A node of the range's surfaces: cut in two, and the largest part again, until it has all its children.
  int add(const Range& whole) {
    std::vector<Range> parts{whole};
    while (static_cast<int>(parts.size()) < WideNode::width) {
      const auto size = [](const Range& r) { return r.count() > 1 ? half_area(r.box) : -1.0; };
      const auto largest = std::ranges::max_element(parts, {}, size);
      if (largest->count() == 1) break;
      const Range cut = *largest;
      const int middle = partition(cut.first, cut.last, cut.depth);
      *largest = range(cut.first, middle, cut.depth + 1);
      parts.push_back(range(middle, cut.last, cut.depth + 1));
    }
    const std::size_t here = nodes_.size();
    nodes_.emplace_back();
    for (int i = 0; i < WideNode::width; ++i) {
      const bool used = i < static_cast<int>(parts.size());
      std::int32_t child = 0;
      constexpr double infinity = std::numeric_limits<double>::infinity();
      AxisBox box{Vec3{infinity}, Vec3{-infinity}};
      if (used) {
        const Range& part = parts[static_cast<std::size_t>(i)];
        box = part.box;
        child = part.count() == 1 ? ~order_[static_cast<std::size_t>(part.first)] : add(part);
      }
      WideNode& node = nodes_[here];
      node.child[i] = child;
      for (int axis = 0; axis < 3; ++axis) {
        node.lo[axis][i] = box.lo[axis];
        node.hi[axis][i] = box.hi[axis];
      }
    }
    return static_cast<int>(here);
  }

  /// Reorders [first, last) into two non-empty parts and returns where the second begins.
  int partition(int first, int last, int depth) {
    const auto box_of = [&](int surface) -> const AxisBox& {
      return boxes_[static_cast<std::size_t>(surface)];
    };
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
    int axis = 0;
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

  const std::vector<AxisBox>& boxes_;
  std::vector<int> order_;
  std::vector<WideNode> nodes_;
};

}  // namespace

std::vector<WideNode> wide_tree(const std::vector<AxisBox>& boxes) {
  return Builder(boxes).build();
}

}  // namespace backlight
