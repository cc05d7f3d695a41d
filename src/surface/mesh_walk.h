// Where lines cross the triangles of a mesh (mesh_triangle.h), of a tree of them: a template over the number
// of lanes, the same bits for any.
#pragma once

#include "local_lines.h"
#include "mesh_triangle.h"
#include "pyramid.h"

namespace backlight {

struct MeshQuestion {
  MeshView mesh;
  double lambda_min;  ///< only what is beyond counts
  /// Then all that matters is whether there is a crossing in front of lambda_max.
  bool existence_is_enough = false;
  double lambda_max = __builtin_inf();
};

template <int N>
class MeshWalk : TreeWalk<N> {
  using Base = TreeWalk<N>;
  using Base::all_lanes;
  using Base::infinity;
  using Base::lanes_of;
  using Base::pick;
  using Base::visit;
  using typename Base::Mask;
  using typename Base::Pyramid;
  using typename Base::V;
  using typename Base::V3;

 public:
  /// The first crossing of each line and its triangle (of crossings at the same place, the one of the
  /// smallest number); infinity: there is none. Or any, if that is enough.
  static void run(const MeshQuestion& question, const LocalLines& lines, double* t, double* triangle) {
    MeshWalk walk(question, lines, t, triangle);
    const std::uint64_t all = lines.count < 64 ? (std::uint64_t{1} << lines.count) - 1 : ~std::uint64_t{0};
    for (std::size_t i = 0; i < lines.padded(); ++i) t[i] = infinity;
    std::uint64_t groups[6];
    walk.sort(all, groups);
    for (int g = 0; g < 6; ++g) {
      if (groups[g] == 0 || !walk.begin(g / 2, groups[g])) continue;
      visit(
          question.mesh.nodes,
          walk.pyramid_, [&](int number) __attribute__((always_inline)) { return walk.meet(number); });
    }
  }

  /// Calls add(t, triangle) for all crossings of a line, in no order.
  template <class Add>
  static void all(const MeshView& mesh, const LocalLines& line, const Add& add) {
    const MeshQuestion question{mesh, -infinity};
    double t[LocalLines::most], triangle[LocalLines::most];
    MeshWalk walk(question, line, t, triangle);
    std::uint64_t groups[6];
    walk.sort(1, groups);
    for (int g = 0; g < 6; ++g) {
      if (groups[g] == 0 || !walk.begin(g / 2, groups[g])) continue;
      visit(mesh.nodes, walk.pyramid_, [&](int number) {
        V at;
        if ((bits(walk.crossing(walk.corners_of(number), 0, at)) & 1U) != 0) {
          double found[N];
          at.store(found);
          add(found[0], number);
        }
        return false;
      });
    }
  }

 private:
  MeshWalk(const MeshQuestion& question, const LocalLines& lines, double* t, double* triangle)
      : question_(question), lines_(lines), t_(t), triangle_(triangle) {
    for (int k = 0; k < 3; ++k) {
      const double width = question.mesh.high[k] - question.mesh.low[k];
      size_ = width > size_ ? width : size_;
    }
  }

  /// The lines by the axis that they go along most, and the way that they go.
  void sort(std::uint64_t active, std::uint64_t (&groups)[6]) const {
    for (std::uint64_t& group : groups) group = 0;
    for (std::size_t i = 0; i < lines_.padded(); i += N) {
      const unsigned lanes = lanes_of(active, static_cast<int>(i));
      if (lanes == 0) continue;
      const V3 d = load3<V>(lines_.direction, i);
      const V x = magnitude(d.x), y = magnitude(d.y), z = magnitude(d.z), zero(0.0);
      const unsigned along_x = bits((x >= y) & (x >= z)), along_y = bits(y >= z) & ~along_x;
      const unsigned backwards[3] = {bits(d.x < zero), bits(d.y < zero), bits(d.z < zero)};
      const unsigned along[3] = {along_x, along_y, all_lanes & ~(along_x | along_y)};
      for (int k = 0; k < 3; ++k) {
        groups[2 * k] |= static_cast<std::uint64_t>(along[k] & ~backwards[k] & lanes) << i;
        groups[2 * k + 1] |= static_cast<std::uint64_t>(along[k] & backwards[k] & lanes) << i;
      }
    }
  }

  /// Makes the pyramids of some lines, from where they get to the mesh or begin. False: they are not numbers.
  bool begin(int axis, std::uint64_t active) {
    open_ = active;
    a_ = axis;
    b_ = (axis + 1) % 3;
    c_ = (axis + 2) % 3;
    rays_.padded = static_cast<int>(lines_.padded());
    rays_.one_origin = false;
    const MeshView& mesh = question_.mesh;
    const double room = 1e-12 * size_;
    for (std::size_t i = 0; i < lines_.padded(); i += N) {
      const V3 d = load3<V>(lines_.direction, i), p = load3<V>(lines_.point, i);
      const V inverse = V(1.0) / V::load(lines_.direction[a_] + i);
      const V at_low = (V(mesh.low[a_]) - V::load(lines_.point[a_] + i)) * inverse;
      const V at_high = (V(mesh.high[a_]) - V::load(lines_.point[a_] + i)) * inverse;
      const V start =
          (V(question_.lambda_min) - V::load(lines_.lambda_centre + i) - V::load(lines_.lambda_shift + i)) /
          V::load(lines_.lambda_per_length + i);
      const V stop =
          (V(question_.lambda_max) - V::load(lines_.lambda_centre + i) - V::load(lines_.lambda_shift + i)) /
          V::load(lines_.lambda_per_length + i);
      const V from = larger(start, smaller(at_low, at_high)) - V(room);
      from.store(from_ + i);
      ((stop - from) + V(room)).store(reach_ + i);
      (V::load(lines_.direction[b_] + i) * inverse).store(shear_b_ + i);
      (V::load(lines_.direction[c_] + i) * inverse).store(shear_c_ + i);
      inverse.store(inverse_ + i);
      store3(p + from * d, rays_.origin, i);
      store3(d, rays_.direction, i);
    }
    if (!pyramid_.make(rays_, active, reach_)) return false;
    used_ = (rays_.padded / N + N - 1) / N * N;
    for (int r = 0; r < used_; ++r) make_register(r);
    return true;
  }

  // A pyramid for each register of lines, as arrays by register: one box is asked of several.
  static constexpr int registers = sheet_size / N;
  struct Ends {
    alignas(64) double low[registers < N ? N : registers], high[registers < N ? N : registers];

    void set(int r, double least, double most, double room) {
      low[r] = least - room;
      high[r] = most + room;
    }
  };

  void make_register(int r) {
    const int i = r * N;
    const unsigned lanes = i < rays_.padded ? lanes_of(open_, i) : 0;
    far_[r] = -infinity;
    if (lanes == 0) return;
    double terms = 0.0, least[3], most[3];
    for (int k = 0; k < 3; ++k) {
      const V at = V::load(rays_.origin[k] + i);
      least[k] = least_of(pick(lanes, at, V(infinity)));
      most[k] = most_of(pick(lanes, at, V(-infinity)));
      const double size = most[k] > -least[k] ? most[k] : -least[k];
      terms = size > terms ? size : terms;
    }
    for (int k = 0; k < 3; ++k) starts_[k].set(r, least[k], most[k], 6e-15 * (terms + size_));
    far_room_[r] = 1e-12 * size_;
    const double backwards = lines_.direction[a_][i + __builtin_ctz(lanes)] < 0.0 ? -1.0 : 1.0;
    forwards_ = backwards > 0.0;
    const double* const shears[2] = {shear_b_ + i, shear_c_ + i};
    for (int k = 0; k < 2; ++k) {
      const V slope = V(backwards) * V::load(shears[k]);
      slopes_[k].set(r, least_of(pick(lanes, slope, V(infinity))), most_of(pick(lanes, slope, V(-infinity))),
                     8e-15);  // slopes are no greater than 1
    }
    set_far(r, lanes);
  }

  void set_far(int r, unsigned lanes) {
    const int i = r * N;
    const V way = V::load(reach_ + i) * magnitude(V::load(lines_.direction[a_] + i));
    far_[r] = most_of(pick(lanes, way, V(0.0))) * (1.0 + 1e-14) + far_room_[r];
  }

  /// Of all registers.
  [[nodiscard]] BACKLIGHT_LANES double farthest() const {
    V most = V::load(far_);
    for (int r = N; r < used_; r += N) most = larger(most, V::load(far_ + r));
    return most_of(most);
  }

  /// Which registers a box may be met by.
  BACKLIGHT_LANES std::uint64_t registers_at(const double (&low)[3], const double (&high)[3]) const {
    std::uint64_t met = 0;
    for (int r = 0; r < used_; r += N) {
      const V lo(low[a_]), hi(high[a_]);
      const V first = V::load(starts_[a_].low + r), last = V::load(starts_[a_].high + r);
      const V begin = forwards_ ? lo - last : first - hi;
      const V end = forwards_ ? hi - first : last - lo;
      const V from = larger(begin, V(0.0));
      const Mask there = (end >= V(0.0)) & (begin <= V::load(far_ + r)) &
                         between(low[b_], high[b_], starts_[b_], slopes_[0], r, from, end) &
                         between(low[c_], high[c_], starts_[c_], slopes_[1], r, from, end);
      met |= static_cast<std::uint64_t>(bits(there)) << r;
    }
    return met;
  }

  static BACKLIGHT_LANES Mask between(double low, double high, const Ends& starts, const Ends& slopes, int r,
                                      V from, V end) {
    const V least = V::load(slopes.low + r), most = V::load(slopes.high + r), zero(0.0);
    const V lowest = least * select(least >= zero, from, end);
    const V highest = most * select(most >= zero, end, from);
    return (V(high) - V::load(starts.low + r) >= lowest) & (V(low) - V::load(starts.high + r) <= highest);
  }

  struct Corners {
    const double* at[3];
  };
  static BACKLIGHT_LANES Corners corners_of(const MeshView& mesh, int number) {
    const std::uint32_t* const its = mesh.triangles[number];
    return {{mesh.places[its[0]], mesh.places[its[1]], mesh.places[its[2]]}};
  }
  [[nodiscard]] BACKLIGHT_LANES Corners corners_of(int number) const {
    return corners_of(question_.mesh, number);
  }

  /// Tries a triangle on the lines whose registers may meet it; true: no line is left.
  BACKLIGHT_LANES bool meet(int number) {
    const Corners corners = corners_of(number);
    double low[3], high[3];
    for (int k = 0; k < 3; ++k) {
      const double a = corners.at[0][k], b = corners.at[1][k], c = corners.at[2][k];
      const double less = a < b ? a : b, more = a < b ? b : a;
      low[k] = c < less ? c : less;
      high[k] = c > more ? c : more;
    }
    bool nearer = false;
    for (std::uint64_t met = registers_at(low, high); met != 0; met &= met - 1) {
      nearer = meet(corners, number, __builtin_ctzll(met)) || nearer;
    }
    if (question_.existence_is_enough) return open_ == 0;
    if (nearer) pyramid_.shorten(farthest());
    return false;
  }

  BACKLIGHT_LANES bool meet(const Corners& corners, int number, int r) {
    const int i = r * N;
    const unsigned open = lanes_of(open_, i);
    V at;
    const Mask crossed = crossing(corners, i, at);
    if ((bits(crossed) & open) == 0) return false;
    const V lambda = V::load(lines_.lambda_centre + i) +
                     (V::load(lines_.lambda_shift + i) + at * V::load(lines_.lambda_per_length + i));
    const V before = V::load(t_ + i), whose = V::load(triangle_ + i), who(static_cast<double>(number));
    const Mask counts = crossed & (lambda > V(question_.lambda_min)) & (lambda < V(question_.lambda_max));
    const unsigned nearer = bits(counts & ((at < before) | ((at == before) & (who < whose)))) & open;
    if (nearer == 0) return false;
    pick(nearer, at, before).store(t_ + i);
    pick(nearer, who, whose).store(triangle_ + i);
    if (question_.existence_is_enough) {
      open_ &= ~(static_cast<std::uint64_t>(nearer) << i);
      if ((open & ~nearer) == 0) far_[r] = -infinity;
      return true;
    }
    pick(nearer, at - V::load(from_ + i), V::load(reach_ + i)).store(reach_ + i);
    set_far(r, open);
    return true;
  }

  /// Which lanes of the register cross the triangle, and where.
  BACKLIGHT_LANES Mask crossing(const Corners& corners, int i, V& t) const {
    const auto corner = [&](const double* at) __attribute__((always_inline)) {
      return V3(V(at[a_]), V(at[b_]), V(at[c_]));
    };
    const TriangleEdges<V> e = triangle_edges(
        corner(corners.at[0]), corner(corners.at[1]), corner(corners.at[2]),
        V3(V::load(lines_.point[a_] + i), V::load(lines_.point[b_] + i), V::load(lines_.point[c_] + i)),
        V::load(shear_b_ + i), V::load(shear_c_ + i));
    const V zero(0.0);
    const Mask inside = ((e.side_u > zero) & (e.side_v > zero) & (e.side_w > zero)) |
                        ((e.side_u < zero) & (e.side_v < zero) & (e.side_w < zero));
    if (bits(inside) == 0) return inside;
    const V sum = e.u * e.at_a + e.v * e.at_b + e.w * e.at_c;
    t = sum / (e.u + e.v + e.w) * V::load(inverse_ + i);
    return inside;
  }

  const MeshQuestion& question_;
  const LocalLines& lines_;
  double* t_;
  double* triangle_;
  double size_ = 0.0;
  std::uint64_t open_ = 0;
  int a_ = 0, b_ = 1, c_ = 2;
  bool forwards_ = true;
  int used_ = 0;   // registers, rounded up to what is looked at together
  RaySheet rays_;  // from where they get to the mesh
  alignas(64) double from_[sheet_size],
      reach_[sheet_size];  // their lines' parameters there; from there to what is met
  alignas(64) double shear_b_[sheet_size], shear_c_[sheet_size], inverse_[sheet_size];
  Pyramid pyramid_;
  Ends starts_[3], slopes_[2];
  alignas(64) double far_[registers < N ? N : registers], far_room_[registers < N ? N : registers];
};

}  // namespace backlight
