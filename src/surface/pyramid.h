// What goes down a tree of boxes: a pyramid around some of the rays of a sheet; and the way down. A template
// over the number of lanes.
#pragma once

#include "backlight/surface/ray_sheet.h"
#include "hierarchy.h"

namespace backlight {

/// For those that derive from it: the frame's surfaces (walk.h), and the triangles of a mesh (mesh_walk.h).
template <int N>
class TreeWalk {
 protected:
  using V = Lanes<N>;
  using V3 = LaneVec3<V>;
  using Mask = LaneMask<N>;

  static constexpr unsigned all_lanes = (1U << N) - 1U;
  static constexpr double infinity = __builtin_inf();

  static BACKLIGHT_LANES unsigned lanes_of(std::uint64_t rays, int i) {
    return static_cast<unsigned>(rays >> i) & all_lanes;
  }

  /// `a` where the bits are set, `b` elsewhere.
  static BACKLIGHT_LANES V pick(unsigned lanes, V a, V b) {
    return lanes == all_lanes ? a : select(mask_of_bits<N>(lanes), a, b);
  }

  static BACKLIGHT_LANES V3 origin_of(const RaySheet& rays, int i) {
    if (rays.one_origin) return {V(rays.origin[0][0]), V(rays.origin[1][0]), V(rays.origin[2][0])};
    return load3<V>(rays.origin, i);
  }

  /// The pyramid around some rays: from a box of origins, along one axis of the frame, between two slopes
  /// along either of the others.
  class Pyramid {
   public:
    /// Of rays that go as far as `lambda` says of each. False: they do not all go the same way along the axis
    /// that the first one goes along.
    bool make(const RaySheet& rays, std::uint64_t active, const double* lambda) {
      Box origins;
      for (int k = 0; k < 3; ++k) origins.set(k, rays.origin[k][0], rays.origin[k][0], 0.0);
      if (!rays.one_origin) origins = around(rays, active, 0.0);
      return make(origins, 1.0, rays, active, lambda, infinity);
    }

    /// Of segments that end at lambda_max, where it begins: the light of a lamp comes from a point, or from
    /// few.
    bool make(const RaySheet& rays, std::uint64_t active, double lambda_max) {
      const bool back = lambda_max < infinity;
      const Box begin = around(rays, active, back ? lambda_max : 0.0);
      return make(begin, back ? -1.0 : 1.0, rays, active, nullptr, lambda_max);
    }

    /// Of rays the ends of whose origins and slopes are known, with room for their rounding: along the first
    /// of the axes, as `sign` tells, and across, by that coordinate.
    void make(const int (&axis)[3], double sign, const double (&low)[3], const double (&high)[3],
              const double (&slope)[2][2]) {
      for (int k = 0; k < 3; ++k) {
        axis_[k] = axis[k];
        low_[axis[k]] = low[k];
        high_[axis[k]] = high[k];
      }
      sign_[axis[0]] = sign;
      for (int k = 0; k < 2; ++k) {
        slope_[k][0] = sign > 0.0 ? slope[k][0] : -slope[k][1];
        slope_[k][1] = sign > 0.0 ? slope[k][1] : -slope[k][0];
      }
    }

    /// How far along the axis it reaches.
    double far = infinity;

    /// The same once the rays have met something.
    void shorten(const RaySheet& rays, std::uint64_t active, const double* lambda) {
      const V sign(sign_[axis_[0]]);
      V most(0.0);
      for (int i = 0; i < rays.padded; i += N) {
        const unsigned lanes = lanes_of(active, i);
        if (lanes == 0) continue;
        most = larger(
            most, pick(lanes, V::load(lambda + i) * (sign * V::load(rays.direction[axis_[0]] + i)), most));
      }
      far = most_of(most) * (1.0 + 1e-14) + reach_room_;
    }

    /// Bits: the children it meets; `near`: how far along the axis they begin.
    unsigned meets(const WideNode& node, double (&near)[WideNode::width]) const {
      unsigned all = 0;
      const int a = axis_[0], b = axis_[1], c = axis_[2];
      const bool forwards = sign_[a] > 0.0;
      for (int k = 0; k < WideNode::width; k += N) {
        const V lo = V::load(node.lo[a] + k), hi = V::load(node.hi[a] + k);
        const V begin = forwards ? lo - V(high_[a]) : V(low_[a]) - hi;
        const V end = forwards ? hi - V(low_[a]) : V(high_[a]) - lo;
        const V from = larger(begin, V(0.0));
        const Mask met = (end >= V(0.0)) & (begin <= V(far)) & between(node, b, slope_[0], from, end, k) &
                         between(node, c, slope_[1], from, end, k);
        begin.store(near + k);
        all |= bits(met) << k;
      }
      return all;
    }

   private:
    struct Box {
      double low[3], high[3];

      /// With room for the rounding of differences from it, and of sums of numbers as large as `terms`.
      void set(int k, double least, double most, double terms) {
        const double room = 2e-15 * ((least < 0.0 ? -least : least) + (most < 0.0 ? -most : most) + terms);
        low[k] = least - room;
        high[k] = most + room;
      }
      [[nodiscard]] double size() const {
        return (high[0] - low[0]) + (high[1] - low[1]) + (high[2] - low[2]);
      }
    };

    /// Around where rays are at `lambda`.
    static Box around(const RaySheet& rays, std::uint64_t active, double lambda) {
      V3 least{V(infinity), V(infinity), V(infinity)}, most = -least;
      V terms(0.0);
      for (int i = 0; i < rays.padded; i += N) {
        const unsigned lanes = lanes_of(active, i);
        if (lanes == 0) continue;
        const auto take = [&](V start, V direction, V & low, V & high) __attribute__((always_inline)) {
          const V way = V(lambda) * direction, end = start + way;
          low = smaller(low, pick(lanes, end, low));
          high = larger(high, pick(lanes, end, high));
          terms = larger(terms, pick(lanes, magnitude(start) + magnitude(way), terms));
        };
        const V3 origin = origin_of(rays, i), direction = load3<V>(rays.direction, i);
        take(origin.x, direction.x, least.x, most.x);
        take(origin.y, direction.y, least.y, most.y);
        take(origin.z, direction.z, least.z, most.z);
      }
      Box box;
      const double all_terms = most_of(terms);
      box.set(0, least_of(least.x), most_of(most.x), all_terms);
      box.set(1, least_of(least.y), most_of(most.y), all_terms);
      box.set(2, least_of(least.z), most_of(most.z), all_terms);
      return box;
    }

    /// `way`: 1, or -1 for rays backwards.
    bool make(const Box& origins, double way, const RaySheet& rays, std::uint64_t active,
              const double* lambda, double lambda_max) {
      const int first = __builtin_ctzll(active);
      double size[3];
      for (int k = 0; k < 3; ++k) {
        low_[k] = origins.low[k];
        high_[k] = origins.high[k];
        const double d = way * rays.direction[k][first];
        sign_[k] = d < 0.0 ? -1.0 : 1.0;
        size[k] = d * sign_[k];
      }
      axis_[0] = size[0] >= size[1] ? (size[0] >= size[2] ? 0 : 2) : (size[1] >= size[2] ? 1 : 2);
      axis_[1] = axis_[0] == 0 ? 1 : 0;
      axis_[2] = axis_[0] == 2 ? 1 : 2;
      reach_room_ = origins.size();
      const V sign(sign_[axis_[0]] * way);
      V low[2] = {V(infinity), V(infinity)}, high[2] = {V(-infinity), V(-infinity)}, most(0.0);
      for (int i = 0; i < rays.padded; i += N) {
        const unsigned lanes = lanes_of(active, i);
        if (lanes == 0) continue;
        const V along = sign * V::load(rays.direction[axis_[0]] + i);
        if ((bits(along > V(0.0)) & lanes) != lanes) return false;
        const V limit = lambda == nullptr ? V(lambda_max) : V::load(lambda + i);
        most = larger(most, pick(lanes, limit * along, most));
        const V inverse = V(way) / along;
        for (int k = 0; k < 2; ++k) {
          const V slope = V::load(rays.direction[axis_[k + 1]] + i) * inverse;
          low[k] = smaller(low[k], pick(lanes, slope, low[k]));
          high[k] = larger(high[k], pick(lanes, slope, high[k]));
        }
      }
      far = most_of(most) * (1.0 + 1e-14) + reach_room_;
      for (int k = 0; k < 2; ++k) {
        const double least = least_of(low[k]), greatest = most_of(high[k]);
        slope_[k][0] = least - 2e-15 * (1.0 + (least < 0.0 ? -least : least));
        slope_[k][1] = greatest + 2e-15 * (1.0 + (greatest < 0.0 ? -greatest : greatest));
      }
      return true;
    }

    // Whether boxes reach between the slopes somewhere from `from` to `end` along the axis.
    BACKLIGHT_LANES Mask between(const WideNode& node, int axis, const double (&slope)[2], V from, V end,
                                 int k) const {
      const V lo = V::load(node.lo[axis] + k) - V(high_[axis]),
              hi = V::load(node.hi[axis] + k) - V(low_[axis]);
      const V lowest = V(slope[0]) * (slope[0] >= 0.0 ? from : end);
      const V highest = V(slope[1]) * (slope[1] >= 0.0 ? end : from);
      return (hi >= lowest) & (lo <= highest);
    }

    int axis_[3];  // the one that the rays go along, and the others
    double sign_[3];
    double low_[3], high_[3];  // of the origins
    double slope_[2][2];
    double reach_room_;
  };

  /// Calls work(child, near) for the surfaces that the pyramid meets, near ones first; it returns true to
  /// stop.
  template <class Work>
  static BACKLIGHT_LANES void visit(const WideNode* nodes, const Pyramid& pyramid, const Work& work) {
    struct Pending {
      double near;
      std::int32_t child;
    };
    Pending stack[768];  // of 96 levels
    int pending = 0;
    std::int32_t current = 0;
    while (true) {
      if (current >= 0) {
        const WideNode& node = nodes[current];
        double near[WideNode::width];
        const int bottom = pending;
        for (unsigned met = pyramid.meets(node, near); met != 0; met &= met - 1) {
          const int i = __builtin_ctz(met);
          int place = pending++;
          for (; place > bottom && stack[place - 1].near < near[i]; --place) stack[place] = stack[place - 1];
          stack[place] = {near[i], node.child[i]};
        }
      } else if (work(~current)) {
        return;
      }
      do {
        if (pending == 0) return;
        current = stack[--pending].child;
      } while (stack[pending].near > pyramid.far);
    }
  }
};

}  // namespace backlight
