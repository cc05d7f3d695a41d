// Which of a frame's surfaces up to 64 rays meet first, or whether they meet any: a template over the number
// of lanes, the same bits for any.
// Longer than 400 lines: one template, whose questions share its ways of looking at rays and surfaces.
// The rays go down the tree of boxes (hierarchy.h) together, as a pyramid around all of them: which children
// that meets is asked of eight boxes at once. At a surface each register of rays is asked whether it may meet
// the bounding sphere, and then solves the closed form. Formulas, solids and tori are asked about all those
// rays by functions from outside, which have lanes of their own.
#pragma once

#include <type_traits>

#include "backlight/surface/ray_sheet.h"
#include "forms.h"
#include "hierarchy.h"
#include "pyramid.h"

namespace backlight {

/// What a walk is given besides the rays.
struct WalkSurfaces {
  const WideNode* nodes;  ///< null: there is no tree
  const PlacedSurface* surfaces;
  const int* direct;  ///< surfaces that are asked whatever the rays: those without bounds, and a lone one
  int direct_count;
  bool is_lone;      ///< there is but one surface, whose bounds the rays are known to meet
  double first_who;  ///< number of surface 0 among the hits
  // For surfaces without a closed form: as below for one surface, of the rays whose bits are set.
  const void* set;
  bool (*nearest_of)(const void* set, int surface, std::uint64_t rays, const RaySheet&, double who,
                     SheetHits&);
  std::uint64_t (*blocked_by)(const void* set, int surface, std::uint64_t rays, const RaySheet&,
                              double lambda_max);
  PassingBall known_passing;  ///< of a travelling ball, if it is known before
  /// What the rays whose bits are set can meet of a travelling ball, if they are light: to where they are at
  /// λ = 0, which is one event, or from where they are at another λ.
  PassingBall (*passing)(const void* set, int surface, std::uint64_t rays, const RaySheet&, double lambda);
};

/// What is asked about shadow rays.
struct ShadowQuestion {
  double lambda_max;
  /// By ray: the number of its own surface, which surely does not shade it; or -1.
  const double* own;
};

template <int N>
class Walk : TreeWalk<N> {
  using Base = TreeWalk<N>;
  using Base::all_lanes;
  using Base::infinity;
  using Base::lanes_of;
  using Base::origin_of;
  using Base::pick;
  using Base::visit;
  using typename Base::Mask;
  using typename Base::Pyramid;
  using typename Base::V;
  using typename Base::V3;

 public:
  /// Updates the hits of the rays whose bits are set where a surface is nearer; of equal λ, the smaller
  /// number counts.
  static void nearest(const WalkSurfaces& s, const RaySheet& rays, std::uint64_t active, SheetHits& hits) {
    for (int i = 0; i < s.direct_count; ++i) nearest_of(s, s.direct[i], rays, active, hits);
    if (s.nodes != nullptr) descend(s, rays, active, hits);
  }

  /// Of the rays whose bits are set, those that meet a surface that casts a shadow at a λ in (0, lambda_max).
  static std::uint64_t blocked(const WalkSurfaces& s, const RaySheet& rays, std::uint64_t active,
                               const ShadowQuestion& question) {
    std::uint64_t open = active;
    for (int i = 0; i < s.direct_count && open != 0; ++i) {
      open &= ~blocked_by(s, s.direct[i], rays, open, question);
    }
    if (s.nodes != nullptr && open != 0) open &= ~descend(s, rays, open, question);
    return active & ~open;
  }

  /// The points of hits `first` to `last`, all on one surface that has a form; `local`, if not null: the same
  /// in its local coordinates. Bits: those that are left to the law.
  static std::uint64_t points(const LaneSurface& surface, const RaySheet& rays, int first, int last,
                              const SheetHits& hits, SheetPoints& out, double (*local)[sheet_size]) {
    std::uint64_t left = 0;
    const auto use = [&](auto form) __attribute__((always_inline)) {
      left = points_by<decltype(form)>(surface, rays, first, last, hits, out, local);
    };
    if (!with_form(surface.kind, use)) use(TorusForm{});
    return left;
  }

 private:
  /// Which rays of a register may meet a surface's bounding sphere and its box: with room for all rounding.
  template <bool boxed>
  class Sight {
   public:
    BACKLIGHT_LANES Sight(const LaneSurface& surface, bool is_lone, const RaySheet& rays, double lambda_max)
        : surface_(surface),
          lambda_max_(lambda_max),
          one_(rays.one_origin),
          all_(is_lone || !(surface.radius < infinity)),
          half_(V(1.0 + 1e-11) * V3(surface.half)),
          start_(half_),
          room_(1e-14 * surface.stretch),
          reach_(room_) {
      if (!one_) return;
      double square = 0.0;
      for (int k = 0; k < 3; ++k) {
        to_[k] = surface.centre[k] - rays.origin[k][0];
        square += to_[k] * to_[k];
      }
      if (boxed) set_start(-V3(to_));
      if (all_) return;
      const double left = square - surface.radius * surface.radius * (1.0 + 1e-11);
      all_ = !(left > 0.0);
      level_ = __builtin_sqrt(all_ ? 0.0 : left) - 1e-11 * __builtin_sqrt(square);
    }

    [[nodiscard]] BACKLIGHT_LANES unsigned lanes(const RaySheet& rays, int i) {
      if (all_) return boxed ? lanes_to_box(rays, i) : all_lanes;
      const V3 d = load3<V>(rays.direction, i);
      const V size = V::load(rays.length + i);
      if (one_) {
        const unsigned met = bits(dot(d, V3(to_)) >= V(level_) * size);
        return met == 0 || !boxed ? met : met & lanes_to_box(rays, i);
      }
      if (boxed) return lanes_to_box(rays, i);
      // The closest approach to the centre, without a division.
      const V3 o = load3<V>(rays.origin, i) - V3(surface_.centre);
      const V square = dot(o, o), along = dot(o, d), square_length = dot(d, d);
      const V reach = (V(surface_.radius) + V(4e-15) * largest_coordinate(o)) * size * V(1.0 + 1e-11);
      return bits(
          (square * square_length - along * along <= reach * reach + V(1e-14) * square * square_length) &
          (along <= reach) & (-along <= V(lambda_max_) * square_length + reach));
    }

    /// Of the given ones.
    [[nodiscard]] std::uint64_t rays(const RaySheet& sheet, std::uint64_t active) {
      std::uint64_t met = 0;
      for (int i = 0; i < sheet.padded; i += N) {
        const unsigned open = lanes_of(active, i);
        if (open != 0) met |= static_cast<std::uint64_t>(open & lanes(sheet, i)) << i;
      }
      return met;
    }

   private:
    BACKLIGHT_LANES void set_start(V3 from_centre) {
      start_ = surface_.aligned ? from_centre : surface_.local_from_rest.times(from_centre);
      reach_ = room_ * (largest_coordinate(from_centre) + V(surface_.radius));
    }

    // Lines and boxes are apart if they are so along an edge of the box, or across it and the line.
    [[nodiscard]] BACKLIGHT_LANES unsigned lanes_to_box(const RaySheet& rays, int i) {
      if (!one_) set_start(load3<V>(rays.origin, i) - V3(surface_.centre));
      V3 d = load3<V>(rays.direction, i);
      if (!surface_.aligned) d = surface_.local_from_rest.times(d);
      const V3 p = start_, half = half_, size{magnitude(d.x), magnitude(d.y), magnitude(d.z)};
      const V length = V::load(rays.length + i), noise = V(surface_.stretch) * reach_ * length;
      Mask met = (magnitude(p.y * d.z - p.z * d.y) <= half.y * size.z + half.z * size.y + noise) &
                 (magnitude(p.z * d.x - p.x * d.z) <= half.z * size.x + half.x * size.z + noise) &
                 (magnitude(p.x * d.y - p.y * d.x) <= half.x * size.y + half.y * size.x + noise);
      if (lambda_max_ < infinity) {
        const V middle(0.5 * lambda_max_), more = reach_ + room_ * V(lambda_max_) * length;
        met = met & (magnitude(p.x + middle * d.x) <= half.x + middle * size.x + more) &
              (magnitude(p.y + middle * d.y) <= half.y + middle * size.y + more) &
              (magnitude(p.z + middle * d.z) <= half.z + middle * size.z + more);
      }
      return bits(met);
    }

    const LaneSurface& surface_;
    double lambda_max_;
    bool one_, all_;
    V3 half_, start_;  // of a box; of the rays, in its coordinates
    V room_, reach_;   // for rounding: for each unit of length, and of the way from the start
    double to_[3];     // of one origin: the centre from there
    double level_ = 0.0;
  };

  static std::uint64_t half_of(std::uint64_t rays) {
    std::uint64_t rest = rays;
    for (int left = __builtin_popcountll(rays) / 2; left > 0; --left) rest &= rest - 1;
    return rest;
  }

  static void descend(const WalkSurfaces& s, const RaySheet& rays, std::uint64_t active, SheetHits& hits) {
    Pyramid pyramid;
    if (!pyramid.make(rays, active, hits.lambda)) {
      const std::uint64_t half = half_of(active);
      if (half == active) return;  // not a number
      descend(s, rays, active & ~half, hits);
      descend(s, rays, half, hits);
      return;
    }
    const auto work = [&](int surface) __attribute__((always_inline)) {
      if (nearest_of(s, surface, rays, active, hits)) pyramid.shorten(rays, active, hits.lambda);
      return false;
    };
    visit(s.nodes, pyramid, work);
  }

  static std::uint64_t descend(const WalkSurfaces& s, const RaySheet& rays, std::uint64_t active,
                               const ShadowQuestion& question) {
    Pyramid pyramid;
    if (!pyramid.make(rays, active, question.lambda_max)) {
      const std::uint64_t half = half_of(active);
      if (half == active) return 0;  // not a number
      return descend(s, rays, active & ~half, question) | descend(s, rays, half, question);
    }
    std::uint64_t open = active;
    const auto work = [&](int surface) __attribute__((always_inline)) {
      open &= ~blocked_by(s, surface, rays, open, question);
      return open == 0;
    };
    visit(s.nodes, pyramid, work);
    return active & ~open;
  }

  static bool nearest_of(const WalkSurfaces& s, int index, const RaySheet& rays, std::uint64_t active,
                         SheetHits& hits) {
    if (!s.surfaces[index].lanes.is_carried) return nearest_at_rest(s, index, rays, active, hits);
    RaySheet along;
    go_along<V>(s.surfaces[index].lanes, rays, along);
    return nearest_at_rest(s, index, along, active, hits);
  }

  /// Of the rays those that pass near a travelling ball, where that is clear at once.
  static std::uint64_t near_traveller(const WalkSurfaces& s, int index, const RaySheet& rays,
                                      std::uint64_t active, double lambda) {
    const bool is_known = s.known_passing.radius < infinity;
    if (!is_known && rays.padded <= 8) return active;
    const PassingBall ball = is_known ? s.known_passing : s.passing(s.set, index, active, rays, lambda);
    std::uint64_t met = 0;
    for (int i = 0; i < rays.padded; i += N) {
      const unsigned open = lanes_of(active, i);
      if (open == 0) continue;
      const LaneRay<V> ray{origin_of(rays, i), load3<V>(rays.direction, i)};
      const unsigned near = may_meet(ball, ray, start_of(rays, i), V::load(rays.time_rate + i));
      met |= static_cast<std::uint64_t>(open & near) << i;
    }
    return met;
  }

  static bool nearest_at_rest(const WalkSurfaces& s, int index, const RaySheet& rays, std::uint64_t asked,
                              SheetHits& hits) {
    const LaneSurface& surface = s.surfaces[index].lanes;
    const bool narrows = surface.kind == ShapeKind::travelling_ball && rays.one_origin;
    const std::uint64_t active = narrows ? near_traveller(s, index, rays, asked, 0.0) : asked;
    if (active == 0) return false;
    const double who = s.first_who + index;
    bool nearer = false;
    const auto use = [&](auto form) __attribute__((always_inline)) {
      nearer = nearest_by<decltype(form)>(surface, who, s.is_lone, rays, active, hits);
    };
    if (with_form(surface.kind, use)) return nearer;
    const std::uint64_t near = Sight<false>(surface, s.is_lone, rays, infinity).rays(rays, active);
    return near != 0 && s.nearest_of(s.set, index, near, rays, who, hits);
  }

  template <class Form>
  static constexpr bool is_plane = std::is_same_v<Form, FlatForm<false>>;

  struct First {
    V lambda, along, part;
  };

  /// The first crossing at λ > 0; else a λ that is not.
  template <class Form>
  static BACKLIGHT_LANES First first_crossing(const LaneSurface& surface, const RaySheet& rays, int i,
                                              unsigned wanted) {
    const LaneRay<V> ray{origin_of(rays, i), load3<V>(rays.direction, i)};
    if constexpr (is_plane<Form>) {
      return {plane_lambda(surface, ray), V(__builtin_nan("")), V(0.0)};
    } else if constexpr (Form::travels) {
      const LaneLine<V> line = lane_line(surface, ray);
      BallSearch<V> search(ball_of(surface), line, clock_of(rays, i, line));
      const V along = search.first(line.at_lambda(V(0.0)), mask_of_bits<N>(wanted));
      return {line.lambda(along), along, V(0.0)};
    } else {
      const LaneLine<V> line = lane_line(surface, ray);
      const LaneCrossings<V> found = Form::crossings(surface.values, line);
      const V one = line.lambda(found.t[0]), other = line.lambda(found.t[1]);
      const Mask first = one > V(0.0);
      return {select(first, one, other), select(first, found.t[0], found.t[1]),
              select(first, found.part[0], found.part[1])};
    }
  }

  static BACKLIGHT_LANES V start_of(const RaySheet& rays, int i) {
    return rays.one_origin ? V(rays.start_time[0]) : V::load(rays.start_time + i);
  }

  static BACKLIGHT_LANES LaneClock<V> clock_of(const RaySheet& rays, int i, const LaneLine<V>& line) {
    const V rate = V::load(rays.time_rate + i);
    return {start_of(rays, i) + (line.lambda_centre + line.lambda_shift) * rate,
            line.lambda_per_length * rate};
  }

  template <class Form>
  static BACKLIGHT_LANES bool nearest_by(const LaneSurface& surface, double who, bool is_lone,
                                         const RaySheet& rays, std::uint64_t active, SheetHits& hits) {
    Sight<Form::is_boxed> sight(surface, is_lone, rays, infinity);
    bool any = false;
    for (int i = 0; i < rays.padded; i += N) {
      const unsigned open = lanes_of(active, i), seen = open == 0 ? 0 : open & sight.lanes(rays, i);
      if (seen == 0) continue;
      const First first = first_crossing<Form>(surface, rays, i, seen);
      const V before = V::load(hits.lambda + i), whose = V::load(hits.who + i);
      const Mask nearer =
          (first.lambda > V(0.0)) & ((first.lambda < before) | ((first.lambda == before) & (V(who) < whose)));
      if (bits(nearer) == 0) continue;
      any = true;
      select(nearer, first.lambda, before).store(hits.lambda + i);
      select(nearer, V(who), whose).store(hits.who + i);
      select(nearer, first.along, V::load(hits.along + i)).store(hits.along + i);
      select(nearer, first.part, V::load(hits.part + i)).store(hits.part + i);
    }
    return any;
  }

  static std::uint64_t blocked_by(const WalkSurfaces& s, int index, const RaySheet& rays,
                                  std::uint64_t active, const ShadowQuestion& question) {
    const LaneSurface& surface = s.surfaces[index].lanes;
    if (!surface.casts_shadow) return 0;
    if (!surface.is_carried) return blocked_at_rest(s, index, rays, active, question);
    RaySheet along;
    go_along<V>(surface, rays, along);
    return blocked_at_rest(s, index, along, active, question);
  }

  static std::uint64_t blocked_at_rest(const WalkSurfaces& s, int index, const RaySheet& rays,
                                       std::uint64_t asked, const ShadowQuestion& question) {
    const LaneSurface& surface = s.surfaces[index].lanes;
    const double end = question.lambda_max;
    const bool narrows = surface.kind == ShapeKind::travelling_ball && end < infinity;
    const std::uint64_t active = narrows ? near_traveller(s, index, rays, asked, end) : asked;
    if (active == 0) return 0;
    const double who = s.first_who + index;
    std::uint64_t blocked = 0;
    const auto use = [&](auto form) __attribute__((always_inline)) {
      blocked = blocked_by_form<decltype(form)>(surface, who, s.is_lone, rays, active, question);
    };
    if (with_form(surface.kind, use)) return blocked;
    const std::uint64_t near = Sight<false>(surface, s.is_lone, rays, question.lambda_max).rays(rays, active);
    return near != 0 ? s.blocked_by(s.set, index, near, rays, question.lambda_max) : 0;
  }

  template <class Form>
  static BACKLIGHT_LANES std::uint64_t blocked_by_form(const LaneSurface& surface, double who, bool is_lone,
                                                       const RaySheet& rays, std::uint64_t active,
                                                       const ShadowQuestion& question) {
    Sight<Form::is_boxed> sight(surface, is_lone, rays, question.lambda_max);
    std::uint64_t all = 0;
    for (int i = 0; i < rays.padded; i += N) {
      unsigned open = lanes_of(active, i);
      if (open != 0 && question.own != nullptr) open &= ~bits(V::load(question.own + i) == V(who));
      const unsigned seen = open == 0 ? 0 : open & sight.lanes(rays, i);
      if (seen == 0) continue;
      const V lambda = first_crossing<Form>(surface, rays, i, seen).lambda;
      const unsigned met = bits((lambda > V(0.0)) & (lambda < V(question.lambda_max)));
      all |= static_cast<std::uint64_t>(met & open) << i;
    }
    return all;
  }

  /// Stores the lanes of some rays, as the others are.
  static BACKLIGHT_LANES void put(unsigned lanes, V a, double* to) { pick(lanes, a, V::load(to)).store(to); }
  static BACKLIGHT_LANES void put(unsigned lanes, V3 a, double (*to)[sheet_size], int i) {
    put(lanes, a.x, to[0] + i);
    put(lanes, a.y, to[1] + i);
    put(lanes, a.z, to[2] + i);
  }

  template <class Form>
  static BACKLIGHT_LANES std::uint64_t points_by(const LaneSurface& surface, const RaySheet& rays, int first,
                                                 int last, const SheetHits& hits, SheetPoints& out,
                                                 double (*local)[sheet_size]) {
    std::uint64_t left = 0;
    const std::uint64_t wanted =
        (last < 64 ? (std::uint64_t{1} << last) - 1 : ~std::uint64_t{0}) & (~std::uint64_t{0} << first);
    for (int i = first / N * N; i < last; i += N) {
      const unsigned lanes = lanes_of(wanted, i);
      const LaneLine<V> line =
          lane_line(surface, LaneRay<V>{origin_of(rays, i), load3<V>(rays.direction, i)});
      V along = V::load(hits.along + i);
      if constexpr (is_plane<Form>) {
        along = -line.point.y / line.direction.y;
        const V off = magnitude(line.lambda(along) - V::load(hits.lambda + i));
        const Mask sure = ~(line.direction.y == V(0.0)) & (off < V(infinity));
        left |= static_cast<std::uint64_t>(lanes & ~bits(sure)) << i;
      }
      LaneLocalPoint<V> point;
      if constexpr (Form::travels) {
        const TravellingPoint<V> found = point_of(ball_of(surface), line, clock_of(rays, i, line), along);
        point = found.point;
        put(lanes, found.velocity, out.velocity, i);
        put(lanes, V(0.0), out.own_time + i);
      } else {
        point = Form::point(surface.values, line.at(along), V::load(hits.part + i));
      }
      LanePoint<V> placed = in_rest_frame(surface, point, Form::unit_gradient);
      if (surface.is_carried) {
        const LaneClock<V> clock = clock_of(rays, i, line);
        const CarriedPlace<V> place = carried(surface, placed, clock.start + along * clock.rate);
        placed.position = place.position;
        placed.error_bound = place.error_bound;
        put(lanes, V3(surface.path->velocity), out.velocity, i);
        put(lanes, place.own_time, out.own_time + i);
      }
      if (local != nullptr) put(lanes, point.position, local, i);
      put(lanes, placed.position, out.position, i);
      put(lanes, placed.normal, out.normal, i);
      put(lanes, placed.error_bound, out.error_bound + i);
    }
    return left;
  }
};

}  // namespace backlight
