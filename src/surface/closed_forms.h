// The closed forms: where lines cross each shape, and the points there, over any number of lanes. One lane is
// the law for one ray (shape_table.h); more have the same bits.
//
// A form is a type with
//   crossings(values, line): where a line crosses it, in order;
//   inside_before(values, line): whether the line comes from inside; if that may be so;
//   point(values, p, part): the point next to p put onto the surface, with its gradient, which points
//   outward; unit_gradient: whether its length is 1.
#pragma once

#include "lane_surface.h"

namespace backlight {

/// What is true of most; of a form that says nothing else.
struct ClosedForm {
  static constexpr bool encloses = true, is_convex = true, is_flat = false;  ///< ShapeMethods
  static constexpr bool is_boxed = false;  ///< may fill much more of its box than of a ball
  static constexpr bool travels = false;   ///< is asked otherwise, since it is another one at each time
};

/// Up to two crossings of a line, in order, and the faces; not a number: there is none. (As Crossings.)
template <class V>
struct LaneCrossings {
  V t[2];
  V part[2]{V(0.0), V(0.0)};
};

/// mask ? a : not a number.
template <class V>
BACKLIGHT_LANES V only(typename V::Mask mask, V a) {
  return select(mask, a, V(__builtin_nan("")));
}

/// The stretch of a line inside a convex body, with the faces at its ends. Bodies are intersected by
/// narrowing: a ray through an edge then either meets both faces or misses both, and can never slip in
/// between.
template <class V>
struct LaneStretch {
  V in{-__builtin_inf()};
  V out{__builtin_inf()};
  V part_in{0.0};
  V part_out{0.0};

  BACKLIGHT_LANES void narrow(V enter, V enter_part, V leave, V leave_part) {
    part_in = select(enter > in, enter_part, part_in);
    in = larger(enter, in);
    part_out = select(leave < out, leave_part, part_out);
    out = smaller(leave, out);
  }

  /// |coordinate| <= half, the faces being `low_part` and `low_part` + 1.
  BACKLIGHT_LANES void narrow_to_slab(V point, V direction, V half, double low_part) {
    const typename V::Mask forwards = direction > V(0.0), level = ~(forwards | (direction < V(0.0)));
    const V low = (-half - point) / direction, high = (half - point) / direction;
    const V enter = select(forwards, low, high), leave = select(forwards, high, low);
    const V never = select(magnitude(point) <= half, V(__builtin_inf()), V(-__builtin_inf()));
    const V first(low_part), second(low_part + 1.0);
    narrow(select(level, V(-__builtin_inf()), enter), select(forwards, first, second),
           select(level, never, leave), select(forwards, second, first));
  }

  [[nodiscard]] BACKLIGHT_LANES typename V::Mask is_open() const { return in <= out; }

  [[nodiscard]] BACKLIGHT_LANES LaneCrossings<V> ends() const {
    const typename V::Mask met = is_open() & (in > V(-__builtin_inf())) & (out < V(__builtin_inf()));
    return {{only(met, in), only(met, out)}, {part_in, part_out}};
  }
};

/// The roots of a t² + 2 b t + c, without cancellation: q/a and c/q with q = -(b ± √(b²-ac)), b and the root
/// of the same sign; `low` <= `high`. `discriminant` is b² - ac, non-negative; a is not 0.
template <class V>
struct QuadraticRoots {
  V low, high;

  BACKLIGHT_LANES QuadraticRoots(V a, V b, V c, V discriminant) {
    const V root = sqrt(discriminant);
    const V q = -(b + select(b < V(0.0), -root, root));
    const typename V::Mask twice = q == V(0.0);  // b = 0 and ac = 0
    const V over_a = select(twice, V(0.0), q / a), under_c = select(twice, V(0.0), c / q);
    low = smaller(under_c, over_a);
    high = larger(under_c, over_a);
  }
};

struct SphereForm : ClosedForm {
  static constexpr bool unit_gradient = true;

  // Pythagoras on the perpendicular: no difference of squares of the distance to the viewer.
  template <class V>
  static BACKLIGHT_LANES LaneCrossings<V> crossings(const double* values, const LaneLine<V>& line) {
    const V half_chord = sqrt(V(values[0] * values[0]) - dot(line.point, line.point));
    return {{-half_chord, half_chord}};
  }
  template <class V>
  static BACKLIGHT_LANES LaneLocalPoint<V> point(const double* values, LaneVec3<V> p, V /*part*/) {
    const V inverse = V(1.0) / length(p);
    return {(V(values[0]) * inverse) * p, inverse * p};
  }
};

struct BoxForm : ClosedForm {
  static constexpr bool unit_gradient = true, is_boxed = true;

  template <class V>
  static BACKLIGHT_LANES LaneCrossings<V> crossings(const double* values, const LaneLine<V>& line) {
    LaneStretch<V> stretch;
    stretch.narrow_to_slab(line.point.x, line.direction.x, V(0.5 * values[0]), 0.0);
    stretch.narrow_to_slab(line.point.y, line.direction.y, V(0.5 * values[1]), 2.0);
    stretch.narrow_to_slab(line.point.z, line.direction.z, V(0.5 * values[2]), 4.0);
    return stretch.ends();
  }
  template <class V>
  static BACKLIGHT_LANES LaneLocalPoint<V> point(const double* values, LaneVec3<V> p, V part) {
    LaneLocalPoint<V> result;
    put(0.5 * values[0], 0.0, p.x, part, result.position.x, result.gradient.x);
    put(0.5 * values[1], 2.0, p.y, part, result.position.y, result.gradient.y);
    put(0.5 * values[2], 4.0, p.z, part, result.position.z, result.gradient.z);
    return result;
  }

 private:
  template <class V>
  static BACKLIGHT_LANES void put(double half, double low_part, V p, V part, V& on, V& normal) {
    const typename V::Mask low = part == V(low_part), high = part == V(low_part + 1.0);
    on = select(low, V(-half), select(high, V(half), smaller(larger(p, V(-half)), V(half))));
    normal = select(low, V(-1.0), select(high, V(1.0), V(0.0)));
  }
};

/// Cylinders and cones: radius at the bottom, at the top, and the height.
template <bool is_cylinder>
struct FrustumForm : ClosedForm {
  static constexpr bool unit_gradient = false, is_boxed = true;

  template <class V>
  static BACKLIGHT_LANES LaneCrossings<V> crossings(const double* values, const LaneLine<V>& line) {
    const double bottom = values[0], top = is_cylinder ? values[0] : values[1];
    const double height = is_cylinder ? values[1] : values[2];
    LaneStretch<V> stretch;
    stretch.narrow_to_slab(line.point.y, line.direction.y, V(0.5 * height), 1.0);
    if (bits(stretch.is_open()) != 0) {
      narrow_to_side(stretch, V(0.5 * (bottom + top)), V((top - bottom) / height), line);
    }
    return stretch.ends();
  }

  template <class V>
  static BACKLIGHT_LANES LaneLocalPoint<V> point(const double* values, LaneVec3<V> p, V part) {
    const double bottom = values[0], top = is_cylinder ? values[0] : values[1];
    const double height = is_cylinder ? values[1] : values[2], half = 0.5 * height;
    const V slope((top - bottom) / height), zero(0.0);
    const V y = smaller(larger(p.y, V(-half)), V(half));
    const V wanted = larger(V(0.5 * (bottom + top)) + slope * y, zero);
    const V rho = sqrt(p.x * p.x + p.z * p.z);
    const typename V::Mask off_axis = rho > zero;
    const V divisor = select(off_axis, rho, V(1.0)), scale = select(off_axis, wanted / divisor, zero);
    // On the axis there is only the apex, whose normal is taken along the axis.
    const V apex = select(slope < zero, V(1.0), V(-1.0));
    const LaneLocalPoint<V> side{{p.x * scale, y, p.z * scale},
                                 {p.x / divisor, select(off_axis, -slope, apex), p.z / divisor}};
    const typename V::Mask is_top = part == V(2.0), is_cap = is_top | (part == V(1.0));
    const V up = select(is_top, V(1.0), V(-1.0));
    return {select(is_cap, LaneVec3<V>{p.x, V(half) * up, p.z}, side.position),
            select(is_cap, LaneVec3<V>{zero, up, zero}, side.gradient)};
  }

 private:
  /// x²+z² <= w(y)² with w = middle + slope·y >= 0.
  template <class V>
  static BACKLIGHT_LANES void narrow_to_side(LaneStretch<V>& stretch, V middle, V slope,
                                             const LaneLine<V>& line) {
    using Mask = typename V::Mask;
    const LaneVec3<V>& p = line.point;
    const LaneVec3<V>& d = line.direction;
    const V w = middle + slope * p.y, w_rate = slope * d.y, zero(0.0), unbounded(__builtin_inf());
    const V a = d.x * d.x + d.z * d.z - w_rate * w_rate;
    const V b = p.x * d.x + p.z * d.z - w * w_rate;
    const V c = p.x * p.x + p.z * p.z - w * w;
    // b² - ac by Lagrange's identity: a difference of two squares that is small only where the line is
    // tangent.
    const V twist = difference_of_products(p.x, d.z, p.z, d.x);
    const V cone_x = difference_of_products(p.x, w_rate, w, d.x);
    const V cone_z = difference_of_products(p.z, w_rate, w, d.z);
    const V reach = sqrt(cone_x * cone_x + cone_z * cone_z);
    const V discriminant = (reach - magnitude(twist)) * (reach + magnitude(twist));

    // A line steeper than the cone (a < 0) always meets both nappes; rounding alone makes the discriminant
    // negative. The nappe where w >= 0 lies ahead where w grows.
    const Mask flat = a == zero, round = a > zero;
    const QuadraticRoots<V> roots(select(flat, V(1.0), a), b, c, larger(discriminant, zero));
    const V one = V(-0.5) * c / b;
    const Mask ahead = select(flat, b, -w_rate) < zero;
    V enter = select(round, roots.low, select(ahead, select(flat, one, roots.high), -unbounded));
    V leave = select(round, roots.high, select(ahead, unbounded, select(flat, one, roots.low)));
    const Mask parallel = flat & (b == zero);
    enter = select(parallel, -unbounded, enter);
    const Mask outside = (parallel & (c > zero)) | (round & ~(discriminant >= zero));
    leave = select(outside, -unbounded, select(parallel, unbounded, leave));
    stretch.narrow(enter, zero, leave, zero);
  }
};

/// y = 0: a disk, or all of a plane.
template <bool is_disk>
struct FlatForm : ClosedForm {
  static constexpr bool unit_gradient = true, encloses = !is_disk, is_flat = true, is_boxed = is_disk;

  template <class V>
  static BACKLIGHT_LANES LaneCrossings<V> crossings(const double* values, const LaneLine<V>& line) {
    const V t = -line.point.y / line.direction.y;
    typename V::Mask met = ~(line.direction.y == V(0.0));
    if (is_disk) {
      const LaneVec3<V> p = line.at(t);
      met = met & (p.x * p.x + p.z * p.z <= V(values[0] * values[0]));
    }
    return {{only(met, t), V(__builtin_nan(""))}};
  }
  // The half-space y < 0 of a plane.
  template <class V>
  requires(!is_disk) static BACKLIGHT_LANES typename V::Mask
      inside_before(const double* /*values*/, const LaneLine<V>& line) {
    return select(line.direction.y == V(0.0), line.point.y, -line.direction.y) < V(0.0);
  }
  template <class V>
  static BACKLIGHT_LANES LaneLocalPoint<V> point(const double* /*values*/, LaneVec3<V> p, V /*part*/) {
    return {{p.x, V(0.0), p.z}, {V(0.0), V(1.0), V(0.0)}};
  }
};

/// Where rays meet a plane (maybe at λ < 0); infinity or not a number: nowhere. Only the height above the
/// plane counts: the way to the plane's origin, which may be far, would add its rounding.
template <class V>
BACKLIGHT_LANES V plane_lambda(const LaneSurface& surface, const LaneRay<V>& ray) {
  const auto& m = surface.local_from_rest.column;
  const LaneVec3<V> up{V(m[0][1]), V(m[1][1]), V(m[2][1])};
  const LaneVec3<V> descent{up.x * ray.direction.x, up.y * ray.direction.y, up.z * ray.direction.z};
  const V rate = descent.x + descent.y + descent.z;
  // A ray along a tilted plane has a rate of rounding noise, which is no crossing.
  const V noise = V(2e-15) * (magnitude(descent.x) + magnitude(descent.y) + magnitude(descent.z));
  return only(magnitude(rate) > noise, -dot(up, ray.origin - LaneVec3<V>(surface.centre)) / rate);
}

struct QuadricForm : ClosedForm {
  static constexpr bool unit_gradient = false, is_convex = false;
  static constexpr double epsilon = 0x1p-52;

  /// f(p + t d) = a t² + 2 b t + c.
  template <class V>
  struct Along {
    V a, b, c;

    BACKLIGHT_LANES Along(const double* q, const LaneLine<V>& line) {
      const LaneVec3<V>& p = line.point;
      const LaneVec3<V>& d = line.direction;
      const V terms[6] = {V(q[0]) * d.x * d.x, V(q[1]) * d.y * d.y, V(q[2]) * d.z * d.z,
                          V(q[3]) * d.x * d.y, V(q[4]) * d.x * d.z, V(q[5]) * d.y * d.z};
      V sum(0.0), size(0.0);
      for (const V& term : terms) {
        sum = sum + term;
        size = size + magnitude(term);
      }
      // Along an asymptote the quadratic term is rounding noise, and would invent a crossing some 1e16
      // lengths away.
      a = select(magnitude(sum) <= V(8.0 * epsilon) * size, V(0.0), sum);
      const LaneVec3<V> half_gradient{V(q[0]) * p.x + V(0.5) * (V(q[3]) * p.y + V(q[4]) * p.z + V(q[6])),
                                      V(q[1]) * p.y + V(0.5) * (V(q[3]) * p.x + V(q[5]) * p.z + V(q[7])),
                                      V(q[2]) * p.z + V(0.5) * (V(q[4]) * p.x + V(q[5]) * p.y + V(q[8]))};
      b = dot(half_gradient, d);
      c = dot(half_gradient, p) + V(0.5) * (V(q[6]) * p.x + V(q[7]) * p.y + V(q[8]) * p.z) + V(q[9]);
    }
  };

  // By the sign of f far back along the line.
  template <class V>
  static BACKLIGHT_LANES typename V::Mask inside_before(const double* q, const LaneLine<V>& line) {
    const Along<V> f(q, line);
    const typename V::Mask flat = f.a == V(0.0), level = flat & (f.b == V(0.0));
    return select(level, f.c, select(flat, -f.b, f.a)) < V(0.0);
  }

  template <class V>
  static BACKLIGHT_LANES LaneCrossings<V> crossings(const double* q, const LaneLine<V>& line) {
    const Along<V> f(q, line);
    const V discriminant = difference_of_products(f.b, f.b, f.a, f.c);
    const typename V::Mask flat = f.a == V(0.0);
    const typename V::Mask met = (discriminant >= V(0.0)) & ~(flat & (f.b == V(0.0)));
    const QuadraticRoots<V> roots(select(flat, V(1.0), f.a), f.b, f.c, larger(discriminant, V(0.0)));
    const V one = V(-0.5) * f.c / f.b;
    return {{only(met, select(flat, one, roots.low)), only(met & ~flat, roots.high)}};
  }

  template <class V>
  static BACKLIGHT_LANES LaneLocalPoint<V> point(const double* q, LaneVec3<V> p, V /*part*/) {
    const LaneVec3<V> gradient{V(2.0 * q[0]) * p.x + V(q[3]) * p.y + V(q[4]) * p.z + V(q[6]),
                               V(2.0 * q[1]) * p.y + V(q[3]) * p.x + V(q[5]) * p.z + V(q[7]),
                               V(2.0 * q[2]) * p.z + V(q[4]) * p.x + V(q[5]) * p.y + V(q[8])};
    const V terms[10] = {V(q[0]) * p.x * p.x, V(q[1]) * p.y * p.y,
                         V(q[2]) * p.z * p.z, V(q[3]) * p.x * p.y,
                         V(q[4]) * p.x * p.z, V(q[5]) * p.y * p.z,
                         V(q[6]) * p.x,       V(q[7]) * p.y,
                         V(q[8]) * p.z,       V(q[9])};
    V value(0.0), size(0.0);
    for (const V& term : terms) {
      value = value + term;
      size = size + magnitude(term);
    }
    double curvature = 0.0;
    for (int i = 0; i < 6; ++i) {
      const double its = q[i] < 0.0 ? -q[i] : q[i];
      curvature = its > curvature ? its : curvature;
    }
    const V square = dot(gradient, gradient), none(0.0);
    const typename V::Mask singular = square == none;
    // The value of f is uncertain by some epsilon·size: near a singular point (a cone's apex) that is far in
    // space.
    const V by_slope = V(8.0 * epsilon) * size / sqrt(square);
    const V by_curvature = sqrt(V(8.0 * epsilon) * size / V(curvature));
    const typename V::Mask near = ~singular & (magnitude(value) <= V(0x1p-26) * size);
    const V step = select(near, value / select(singular, V(1.0), square), none);
    LaneLocalPoint<V> result{p - step * gradient, gradient};
    result.gradient.y = select(singular, V(1.0), gradient.y);
    result.error = select(singular, sqrt(V(4.0 * epsilon) * size / V(curvature)),
                          curvature > 0.0 ? smaller(by_curvature, by_slope) : by_slope);
    return result;
  }
};

/// The points alone: its crossings are found by torus_lanes.h.
struct TorusForm : ClosedForm {
  static constexpr bool unit_gradient = false;

  template <class V>
  static BACKLIGHT_LANES LaneLocalPoint<V> point(const double* values, LaneVec3<V> p, V /*part*/) {
    const V rho = sqrt(p.x * p.x + p.z * p.z);
    const V beside = rho - V(values[0]);
    const V scale = V(values[1]) / sqrt(beside * beside + p.y * p.y);
    const V per_rho = V(1.0) / rho;
    const V on_rho = (V(values[0]) + beside * scale) * per_rho;
    return {{p.x * on_rho, p.y * scale, p.z * on_rho}, {p.x * per_rho * beside, p.y, p.z * per_rho * beside}};
  }
};

}  // namespace backlight
