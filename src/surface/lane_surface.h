// A placed surface as plain numbers, and rays brought next to it, over any number of lanes: one lane is the
// law for one ray (local_line.h), and more give the same bits (base/lanes.h).
//
// From afar, the coordinates of a ray's points near a surface are small differences of large numbers. So each
// surface re-origins the ray at its closest approach to the surface's centre c. With λ₀ = -(o-c)·n/n·n
// *rounded to a double*, the point (o-c) + λ₀n is still a point of the exact ray, and is computed with its
// rounding errors carried along (exact.h): right to about one rounding of its own small coordinates, however
// far away the origin. It is off the closest approach by the rounding of λ₀ alone, which is a shift along the
// ray and is taken out afterwards.
#pragma once

#include "backlight/surface/shape.h"
#include "exact.h"

namespace backlight {

struct LanePath;

struct LaneSurface {
  ShapeKind kind = ShapeKind::sphere;
  bool aligned = false;  ///< neither turned nor scaled: the matrices are the unit matrix
  bool casts_shadow = true;
  double centre[3]{};
  LaneMatrix local_from_rest{};
  LaneMatrix rest_from_local{};
  double largest_scale = 1.0;
  double radius = 0.0;             ///< of the bounding sphere about the centre, rest frame; may be infinite
  double values[10]{};             ///< Shape::values
  const LanePath* path = nullptr;  ///< of what goes along one
  bool is_carried = false;         ///< the local coordinates go along it, which is straight
  double half[3]{};                ///< of the box about the local origin, local; of what has bounds
  double stretch = 0.0;            ///< no less than what local_from_rest makes of lengths
};

/// Rays in the rest frame of a surface.
template <class V>
struct LaneRay {
  LaneVec3<V> origin;
  LaneVec3<V> direction;
};

/// The rays in a surface's local coordinates: point + t·direction, t a local length. `direction` is a unit
/// vector, `point` is the closest approach to the local origin (orthogonal to `direction` up to rounding).
template <class V>
struct LaneLine {
  LaneVec3<V> point;
  LaneVec3<V> direction;
  V lambda_centre, lambda_shift, lambda_per_length;

  BACKLIGHT_LANES V lambda(V t) const { return lambda_centre + (lambda_shift + t * lambda_per_length); }
  /// The other way.
  BACKLIGHT_LANES V at_lambda(V lambda) const {
    return (lambda - lambda_centre - lambda_shift) / lambda_per_length;
  }
  BACKLIGHT_LANES LaneVec3<V> at(V t) const { return point + t * direction; }
};

/// (o + λ₀n) - c for one coordinate, right to about one rounding of the result.
template <class V>
BACKLIGHT_LANES V re_origined(V origin, V centre, V lambda, const TwoPart<V>& lambda_split, V direction) {
  const TwoPart<V> offset = two_sum(origin, -centre);
  const TwoPart<V> along = two_product(lambda, direction, lambda_split, split(direction));
  const TwoPart<V> sum = two_sum(offset.value, along.value);
  return sum.value + (sum.error + (offset.error + along.error));
}

/// The rays at their closest approach to the surface's centre.
template <class V>
BACKLIGHT_LANES LaneLine<V> lane_line(const LaneSurface& surface, const LaneRay<V>& ray) {
  const LaneVec3<V>& n = ray.direction;
  const V inverse_square = V(1.0) / dot(n, n);
  const V lambda = -dot(ray.origin - LaneVec3<V>(surface.centre), n) * inverse_square;
  const TwoPart<V> lambda_split = split(lambda);
  LaneVec3<V> point{re_origined(ray.origin.x, V(surface.centre[0]), lambda, lambda_split, n.x),
                    re_origined(ray.origin.y, V(surface.centre[1]), lambda, lambda_split, n.y),
                    re_origined(ray.origin.z, V(surface.centre[2]), lambda, lambda_split, n.z)};
  LaneVec3<V> direction = n;
  if (!surface.aligned) {
    point = surface.local_from_rest.times(point);
    direction = surface.local_from_rest.times(direction);
  }
  const V per_length = surface.aligned ? sqrt(inverse_square) : V(1.0) / length(direction);
  const LaneVec3<V> unit = per_length * direction;
  const V shift = -dot(point, unit);
  return {point + shift * unit, unit, lambda, shift * per_length, per_length};
}

/// A point on a surface in local coordinates, as LocalPoint (shape_table.h).
template <class V>
struct LaneLocalPoint {
  LaneVec3<V> position;
  LaneVec3<V> gradient;
  V error = 0.0;
};

/// The same in the rest frame, as SurfacePoint.
template <class V>
struct LanePoint {
  LaneVec3<V> position;
  LaneVec3<V> normal;
  V error_bound;
};

template <class V>
BACKLIGHT_LANES V largest_coordinate(LaneVec3<V> a) {
  const V x = magnitude(a.x), y = magnitude(a.y), z = magnitude(a.z);
  const V xy = select(x < y, y, x);
  return select(xy < z, z, xy);
}

/// `unit`: the gradients' lengths are 1, to within rounding.
template <class V>
BACKLIGHT_LANES LanePoint<V> in_rest_frame(const LaneSurface& surface, const LaneLocalPoint<V>& point,
                                           bool unit) {
  LanePoint<V> result;
  LaneVec3<V> offset = point.position;
  result.normal = point.gradient;
  if (!surface.aligned) {
    offset = surface.rest_from_local.times(offset);
    // A gradient is a covector: it goes by the transposed inverse, which also keeps it outward in a mirror
    // image.
    result.normal = surface.local_from_rest.transposed_times(point.gradient);
  }
  const LaneVec3<V> centre(surface.centre);
  result.position = centre + offset;
  if (!surface.aligned || !unit) result.normal = (V(1.0) / length(result.normal)) * result.normal;
  const bool bounded = surface.radius < __builtin_inf();
  const V reach = bounded ? V(surface.radius) : V(2.0) * length(offset);
  result.error_bound =
      V(0x1p-48) * (largest_coordinate(centre) + reach) + point.error * V(surface.largest_scale);
  return result;
}

}  // namespace backlight
