// Spheres and planes over lanes: the closed forms of SurfaceSet for several rays at once, to the same bits.
//
// Each function here does what its namesake of SurfaceSet and src/surface does for one ray, operation by
// operation; tests/agreement compares them. Plain numbers only, no frame: see base/lanes.h on why.
#pragma once

#include "backlight/base/lanes.h"

namespace backlight {

/// What the lanes need of a placed surface to bring rays next to it.
struct LanePlacement {
  bool aligned = false;  ///< neither turned nor scaled: the matrices are the unit matrix
  double centre[3]{};
  LaneMatrix local_from_rest{};
};

/// What they need of it besides.
struct LaneSurface : LanePlacement {
  enum class Kind { sphere, plane, other };
  Kind kind = Kind::other;
  LaneMatrix rest_from_local{};
  LaneMatrix normal_from_gradient{};  ///< the transposed inverse
  double radius = 0.0;                ///< sphere: of the shape, in local coordinates
  double bounding_radius = 0.0;       ///< rest frame; infinite for a plane
};

/// Rays in the rest frame of a surface.
template <class V>
struct LaneRay {
  LaneVec3<V> origin;
  LaneVec3<V> direction;
};

template <class V>
struct LaneLine {
  LaneVec3<V> point;
  LaneVec3<V> direction;
  V lambda_centre, lambda_shift, lambda_per_length;

  BACKLIGHT_LANES V lambda(V t) const { return lambda_centre + (lambda_shift + t * lambda_per_length); }
};

/// re_origined of src/surface/local_line.h, with exact.h's sums and products written out.
template <class V>
BACKLIGHT_LANES V lane_re_origined(V origin, double centre, V lambda, V lambda_high, V lambda_low,
                                   V direction) {
  const V c = V(-centre);
  const V offset = origin + c;
  const V c_part = offset - origin;
  const V offset_error = (origin - (offset - c_part)) + (c - c_part);

  const V scaled = V(134217729.0) * direction;
  const V high = scaled - (scaled - direction);
  const V low = direction - high;
  const V along = lambda * direction;
  const V along_error =
      ((lambda_high * high - along) + lambda_high * low + lambda_low * high) + lambda_low * low;

  const V sum = offset + along;
  const V along_part = sum - offset;
  const V sum_error = (offset - (sum - along_part)) + (along - along_part);
  return sum + (sum_error + (offset_error + along_error));
}

/// The rays at their closest approach to the surface's centre: src/surface/local_line.h.
template <class V>
BACKLIGHT_LANES LaneLine<V> lane_line(const LanePlacement& surface, const LaneRay<V>& ray) {
  const LaneVec3<V>& n = ray.direction;
  const V inverse_square = V(1.0) / dot(n, n);
  const V lambda = -dot(ray.origin - LaneVec3<V>(surface.centre), n) * inverse_square;
  const V scaled = V(134217729.0) * lambda;
  const V high = scaled - (scaled - lambda);
  const V low = lambda - high;
  LaneVec3<V> point{lane_re_origined(ray.origin.x, surface.centre[0], lambda, high, low, n.x),
                    lane_re_origined(ray.origin.y, surface.centre[1], lambda, high, low, n.y),
                    lane_re_origined(ray.origin.z, surface.centre[2], lambda, high, low, n.z)};
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

template <class V>
struct LaneCrossing {
  V lambda;
  typename V::Mask found;
};

/// The first crossing at λ > 0.
template <class V>
BACKLIGHT_LANES LaneCrossing<V> lane_sphere_crossing(const LaneSurface& surface, const LaneRay<V>& ray) {
  const LaneLine<V> line = lane_line(surface, ray);
  const V square = V(surface.radius * surface.radius) - dot(line.point, line.point);
  const V half_chord = sqrt(square);
  const V entry = line.lambda(-half_chord);
  const V exit = line.lambda(half_chord);
  const V first = select(entry > V(0.0), entry, exit);
  return {first, (square >= V(0.0)) & (first > V(0.0))};
}

template <class V>
BACKLIGHT_LANES LaneCrossing<V> lane_plane_crossing(const LaneSurface& surface, const LaneRay<V>& ray) {
  const auto& m = surface.local_from_rest.column;
  const LaneVec3<V> up{V(m[0][1]), V(m[1][1]), V(m[2][1])};
  const LaneVec3<V> descent{up.x * ray.direction.x, up.y * ray.direction.y, up.z * ray.direction.z};
  const V rate = descent.x + descent.y + descent.z;
  const V noise = V(2e-15) * (magnitude(descent.x) + magnitude(descent.y) + magnitude(descent.z));
  const V lambda = -dot(up, ray.origin - LaneVec3<V>(surface.centre)) / rate;
  return {lambda, (magnitude(rate) > noise) & (lambda > V(0.0))};
}

template <class V>
BACKLIGHT_LANES LaneCrossing<V> lane_crossing(const LaneSurface& surface, const LaneRay<V>& ray) {
  return surface.kind == LaneSurface::Kind::sphere ? lane_sphere_crossing(surface, ray)
                                                   : lane_plane_crossing(surface, ray);
}

/// As SurfacePoint; `u`, `v` are those of a plane, and not set for a sphere.
template <class V>
struct LanePoint {
  LaneVec3<V> position;
  LaneVec3<V> normal;
  V error_bound;
  V u, v;
  typename V::Mask resolved;  ///< false: SurfaceSet::resolve has to find it
};

template <class V>
BACKLIGHT_LANES V largest_coordinate(LaneVec3<V> a) {
  const V x = magnitude(a.x), y = magnitude(a.y), z = magnitude(a.z);
  const V xy = select(x < y, y, x);
  return select(xy < z, z, xy);
}

/// The points of hits that lane_crossing found at `lambda`: SurfaceSet::resolve.
template <class V>
BACKLIGHT_LANES LanePoint<V> lane_resolve(const LaneSurface& surface, const LaneRay<V>& ray, V lambda) {
  const LaneLine<V> line = lane_line(surface, ray);
  LanePoint<V> result;
  LaneVec3<V> local, gradient;
  V reach;
  if (surface.kind == LaneSurface::Kind::sphere) {
    const V half_chord = sqrt(V(surface.radius * surface.radius) - dot(line.point, line.point));
    const V off_entry = magnitude(line.lambda(-half_chord) - lambda);
    const V off_exit = magnitude(line.lambda(half_chord) - lambda);
    const V t = select(off_exit < off_entry, half_chord, -half_chord);
    const LaneVec3<V> p = line.point + t * line.direction;
    const V inverse = V(1.0) / length(p);
    local = (V(surface.radius) * inverse) * p;
    gradient = inverse * p;
    result.u = result.v = V(0.0);
    result.resolved = off_entry < V(__builtin_inf());
    reach = V(surface.bounding_radius);
  } else {
    const V t = -line.point.y / line.direction.y;
    const LaneVec3<V> p = line.point + t * line.direction;
    local = {p.x, V(0.0), p.z};
    gradient = {V(0.0), V(1.0), V(0.0)};
    result.u = p.x;
    result.v = p.z;
    result.resolved =
        ~(line.direction.y == V(0.0)) & (magnitude(line.lambda(t) - lambda) < V(__builtin_inf()));
  }
  if (surface.aligned) {
    result.position = LaneVec3<V>(surface.centre) + local;
  } else {
    local = surface.rest_from_local.times(local);
    result.position = LaneVec3<V>(surface.centre) + local;
    gradient = surface.normal_from_gradient.times(gradient);
  }
  // The gradients of both are unit vectors where nothing is turned or scaled.
  result.normal = surface.aligned ? gradient : (V(1.0) / length(gradient)) * gradient;
  if (surface.kind != LaneSurface::Kind::sphere) reach = V(2.0) * length(local);
  const LaneVec3<V> centre(surface.centre);
  result.error_bound = V(0x1p-48) * (largest_coordinate(centre) + reach);
  return result;
}

}  // namespace backlight
