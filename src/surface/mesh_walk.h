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
          question.mesh.nodes, walk.pyramid_, [&](int number) __attribute__((always_inline)) {
            walk.meet(number);
            return false;
          });
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
      : question_(question),
        lines_(lines),
        t_(t),
        triangle_(triangle),
        padded_(static_cast<int>(lines.padded())),
        used_((padded_ / N + N - 1) / N * N) {
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

  /// Makes the bounds of some lines, as they are beyond a plane across their axis in front of which nothing
  /// counts. False: they are not numbers, or nothing counts.
  bool begin(int axis, std::uint64_t active) {
    active_ = active;
    a_ = axis;
    b_ = (axis + 1) % 3;
    c_ = (axis + 2) % 3;
    const double* const along = lines_.direction[a_];
    sign_ = along[__builtin_ctzll(active)] < 0.0 ? -1.0 : 1.0;
    const double nearest = sign_ > 0.0 ? question_.mesh.low[a_] : -question_.mesh.high[a_];
    V first(infinity), terms(0.0);
    for (int i = 0; i < padded_; i += N) {
      const unsigned lanes = lanes_of(active, i);
      const V3 point = load3<V>(lines_.point, i);
      terms = larger(magnitude(point.x), larger(magnitude(point.y), larger(magnitude(point.z), terms)));
      const V p = V(sign_) * V::load(lines_.point[a_] + i), d = V(sign_) * V::load(along + i);
      if ((bits(d > V(0.0)) & lanes) != lanes) return false;
      const V per_lambda = V(1.0) / V::load(lines_.lambda_per_length + i);
      const auto depth = [&](double lambda) __attribute__((always_inline)) {
        const V beyond = V(lambda) - V::load(lines_.lambda_centre + i) - V::load(lines_.lambda_shift + i);
        return p + beyond * per_lambda * d;
      };
      const V begin = larger(depth(question_.lambda_min), V(nearest));
      first = smaller(pick(lanes, begin, first), first);
      begin.store(begin_ + i);
      depth(question_.lambda_max).store(end_ + i);
      pick(lanes, V(question_.lambda_max), V(-infinity)).store(last_ + i);
      const V inverse = V(1.0) / V::load(along + i);
      inverse.store(inverse_ + i);
      (V::load(lines_.direction[b_] + i) * inverse).store(shear_[0] + i);
      (V::load(lines_.direction[c_] + i) * inverse).store(shear_[1] + i);
    }
    far_room_ = 1e-12 * size_;
    const double depth = least_of(first) - far_room_;
    if (!(depth < infinity)) return false;
    plane_ = sign_ * depth;
    bound(6e-15 * (most_of(terms) + size_));
    return true;
  }

  // Of each register of lines, as arrays by register: one triangle is asked of several.
  static constexpr int registers = sheet_size / N;
  struct Ends {
    alignas(64) double low[registers], high[registers];
  };

  /// Where the lines begin and end, cross the plane and how they slope, by register and of all together.
  void bound(double room) {
    double low[3], high[3], slope[2][2];
    low[0] = high[0] = plane_;
    for (int k = 0; k < 2; ++k) {
      alignas(64) double at_plane[sheet_size];
      for (int i = 0; i < padded_; i += N) {
        (V::load(lines_.point[k == 0 ? b_ : c_] + i) +
         (V(plane_) - V::load(lines_.point[a_] + i)) * V::load(shear_[k] + i))
            .store(at_plane + i);
      }
      set_ends(at_plane, room, across_[k], low[k + 1], high[k + 1]);
      set_ends(shear_[k], 8e-15, slope_[k], slope[k][0], slope[k][1]);  // they are no greater than 1
    }
    pyramid_.make({a_, b_, c_}, sign_, low, high, slope);
    for (int r = 0; r < used_; r += N) (-most_of_each(begin_, -1.0, r) - V(far_room_)).store(near_ + r);
    set_far();
  }

  void set_ends(const double* values, double room, Ends& ends, double& low, double& high) const {
    V least(infinity), most(-infinity);
    for (int r = 0; r < used_; r += N) {
      const V lows = -most_of_each(values, -1.0, r) - V(room), highs = most_of_each(values, 1.0, r) + V(room);
      lows.store(ends.low + r);
      highs.store(ends.high + r);
      least = smaller(least, lows);
      most = larger(most, highs);
    }
    low = least_of(least);
    high = most_of(most);
  }

  /// How far the lines go at most, by register and of all together.
  BACKLIGHT_LANES void set_far() {
    V most(-infinity);
    for (int r = 0; r < used_; r += N) {
      const V far = most_of_each(end_, 1.0, r) + V(far_room_);
      far.store(far_ + r);
      most = larger(most, far);
    }
    pyramid_.far = most_of(most) - sign_ * plane_;
  }

  /// The most that `sign` times the values of lines are in each of N registers, from register r on.
  BACKLIGHT_LANES V most_of_each(const double* values, double sign, int r) const {
    V rows[N];
    for (int k = 0; k < N; ++k) {
      const int i = (r + k) * N;
      rows[k] = pick(lanes_of(active_, i), V(sign) * V::load(values + i), V(-infinity));
    }
    return backlight::most_of_each(rows);
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

  /// Which registers a triangle may be met by: as the lines see its corners from the plane.
  BACKLIGHT_LANES std::uint64_t registers_at(const Corners& corners) const {
    double beyond[3];
    for (int k = 0; k < 3; ++k) beyond[k] = corners.at[k][a_] - plane_;
    const double a = sign_ * corners.at[0][a_], b = sign_ * corners.at[1][a_], c = sign_ * corners.at[2][a_];
    const double less = a < b ? a : b, more = a < b ? b : a;
    const V least(less < c ? less : c), most(more > c ? more : c);
    std::uint64_t met = 0;
    for (int r = 0; r < used_; r += N) {
      const Mask there = (most >= V::load(near_ + r)) & (least <= V::load(far_ + r)) &
                         between(corners, b_, beyond, across_[0], slope_[0], r) &
                         between(corners, c_, beyond, across_[1], slope_[1], r);
      met |= static_cast<std::uint64_t>(bits(there)) << r;
    }
    return met;
  }

  static BACKLIGHT_LANES Mask between(const Corners& corners, int axis, const double (&beyond)[3],
                                      const Ends& across, const Ends& slope, int r) {
    const V low = V::load(slope.low + r), high = V::load(slope.high + r);
    V least(infinity), most(-infinity);
    for (int k = 0; k < 3; ++k) {
      const V at(corners.at[k][axis]), way(beyond[k]);
      const bool forwards = beyond[k] >= 0.0;
      least = smaller(least, at - way * (forwards ? high : low));
      most = larger(most, at - way * (forwards ? low : high));
    }
    return (least <= V::load(across.high + r)) & (most >= V::load(across.low + r));
  }

  /// Tries a triangle on the lines whose registers may meet it.
  BACKLIGHT_LANES void meet(int number) {
    const Corners corners = corners_of(number);
    unsigned met = 0;
    for (std::uint64_t left = registers_at(corners); left != 0; left &= left - 1) {
      met |= meet(corners, number, __builtin_ctzll(left) * N);
    }
    if (met != 0) set_far();
  }

  /// Without branches, which hardly any order of triangles makes foreseeable.
  BACKLIGHT_LANES unsigned meet(const Corners& corners, int number, int i) {
    V at;
    const Mask crossed = crossing(corners, i, at);
    const V lambda = V::load(lines_.lambda_centre + i) +
                     (V::load(lines_.lambda_shift + i) + at * V::load(lines_.lambda_per_length + i));
    const V before = V::load(t_ + i), whose = V::load(triangle_ + i), who(static_cast<double>(number));
    const V last = V::load(last_ + i), end = V::load(end_ + i);
    const Mask nearer = crossed & (lambda > V(question_.lambda_min)) & (lambda < last) &
                        ((at < before) | ((at == before) & (who < whose)));
    select(nearer, at, before).store(t_ + i);
    select(nearer, who, whose).store(triangle_ + i);
    if (question_.existence_is_enough) {
      select(nearer, V(-infinity), last).store(last_ + i);
      select(nearer, V(-infinity), end).store(end_ + i);
    } else {
      const V depth = V(sign_) * (V::load(lines_.point[a_] + i) + at * V::load(lines_.direction[a_] + i));
      select(nearer, depth, end).store(end_ + i);
    }
    return bits(nearer);
  }

  /// Which lanes of the register cross the triangle, and where.
  BACKLIGHT_LANES Mask crossing(const Corners& corners, int i, V& t) const {
    const auto corner = [&](const double* at) __attribute__((always_inline)) {
      return V3(V(at[a_]), V(at[b_]), V(at[c_]));
    };
    const TriangleEdges<V> e = triangle_edges(
        corner(corners.at[0]), corner(corners.at[1]), corner(corners.at[2]),
        V3(V::load(lines_.point[a_] + i), V::load(lines_.point[b_] + i), V::load(lines_.point[c_] + i)),
        V::load(shear_[0] + i), V::load(shear_[1] + i));
    const V zero(0.0);
    const V sum = e.u * e.at_a + e.v * e.at_b + e.w * e.at_c;
    t = sum / (e.u + e.v + e.w) * V::load(inverse_ + i);
    return ((e.side_u > zero) & (e.side_v > zero) & (e.side_w > zero)) |
           ((e.side_u < zero) & (e.side_v < zero) & (e.side_w < zero));
  }

  const MeshQuestion& question_;
  const LocalLines& lines_;
  double* t_;
  double* triangle_;
  int padded_, used_;  // lines; registers, rounded up to what is looked at together
  double size_ = 0.0, far_room_ = 0.0;
  std::uint64_t active_ = 0;
  int a_ = 0, b_ = 1, c_ = 2;
  double sign_ = 1.0, plane_ = 0.0;  // the way that lines go along the axis; where they are looked at from
  // By line. What is before `begin` and beyond `end`, along the axis, cannot count; nor does λ from `last`
  // on.
  alignas(64) double begin_[sheet_size], end_[sheet_size], last_[sheet_size];
  alignas(64) double shear_[2][sheet_size], inverse_[sheet_size];
  Pyramid pyramid_;
  Ends across_[2], slope_[2];
  alignas(64) double near_[registers], far_[registers];
};

}  // namespace backlight
