#include "hierarchy.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

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
    nodes_.reserve(boxes_.size() / 2 + 1);  // seldom are more needed: what is not is never touched
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
      auto [below, above] = halves(*largest);
      *largest = below;
      parts.push_back(above);
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

  [[nodiscard]] const AxisBox& box_of(int surface) const { return boxes_[static_cast<std::size_t>(surface)]; }

  /// Reorders what is in `whole` into two parts that are not empty.
  std::pair<Range, Range> halves(const Range& whole) {
    if (whole.count() > 2 && whole.depth < cost_depth) {
      if (auto parts = halves_by_cost(whole)) return *parts;
    }
    const int middle = whole.first + whole.count() / 2;  // in file order
    return {range(whole.first, middle, whole.depth + 1), range(middle, whole.last, whole.depth + 1)};
  }

  /// None: all centres coincide.
  std::optional<std::pair<Range, Range>> halves_by_cost(const Range& whole) {
    const auto begin = order_.begin() + whole.first;
    const auto end = order_.begin() + whole.last;
    Vec3 low{1e308};
    Vec3 high{-1e308};
    for (auto k = begin; k != end; ++k) {
      for (int i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], centre(box_of(*k), i));
        high[i] = std::max(high[i], centre(box_of(*k), i));
      }
    }
    Bin bin[3][bins];
    fill_bins(begin, end, low, high, bin);
    int axis = 0;
    BestSplit best{std::numeric_limits<double>::infinity(), -1};
    for (int i = 0; i < 3; ++i) {
      const BestSplit candidate = best_split(bin[i]);
      if (candidate.cost < best.cost) {
        best = candidate;
        axis = i;
      }
    }
    if (best.after_bin < 0) return std::nullopt;
    const Binning binning{low[axis], high[axis]};
    const auto cut = std::stable_partition(
        begin, end, [&](int k) { return binning.bin(centre(box_of(k), axis)) <= best.after_bin; });
    const int middle = static_cast<int>(cut - order_.begin());
    Bin below, above;
    for (int i = 0; i < bins; ++i) (i <= best.after_bin ? below : above).include(bin[axis][i]);
    return std::pair{Range{whole.first, middle, whole.depth + 1, below.box},
                     Range{middle, whole.last, whole.depth + 1, above.box}};
  }

  /// All axes at once: boxes are far apart in memory.
  template <class Iterator>
  void fill_bins(Iterator begin, Iterator end, const Vec3& low, const Vec3& high, Bin (&bin)[3][bins]) const {
    for (auto k = begin; k != end; ++k) {
      const AxisBox& box = box_of(*k);
      for (int i = 0; i < 3; ++i) {
        if (high[i] > low[i]) bin[i][Binning{low[i], high[i]}.bin(centre(box, i))].include({box, 1});
      }
    }
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
