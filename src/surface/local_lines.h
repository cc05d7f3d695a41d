// Many rays brought next to one surface at once: local_line() over lanes, with the same bits.
#pragma once

#include <cmath>
#include <cstddef>

#include "backlight/base/lanes.h"
#include "local_line.h"

namespace backlight {

/// Room for the rounding of LocalLines::lambda(), relative to its terms.
inline constexpr double lambda_room = 1e-14;

/// Rays in the rest frame and, found of them, lines in a surface's local coordinates (LocalLine), as arrays.
struct LocalLines {
  static constexpr std::size_t most = 64;
  /// Numbers of lines are rounded up to a multiple of this; the spare ones do what the last one does.
  static constexpr std::size_t padding = 8;

  std::size_t count = 0;
  alignas(64) double origin[3][most];
  alignas(64) double along[3][most];
  alignas(64) double time[most];
  alignas(64) double rate[most];

  alignas(64) double point[3][most];
  alignas(64) double direction[3][most];
  alignas(64) double lambda_centre[most];
  alignas(64) double lambda_shift[most];
  alignas(64) double lambda_per_length[most];
  alignas(64) double clock_start[most];
  alignas(64) double clock_rate[most];

  [[nodiscard]] BACKLIGHT_LANES std::size_t padded() const {
    return (count + padding - 1) / padding * padding;
  }

  [[nodiscard]] double lambda(std::size_t i, double t) const {
    return lambda_centre[i] + (lambda_shift[i] + t * lambda_per_length[i]);
  }
  /// The line's parameter for a λ.
  [[nodiscard]] double at_lambda(std::size_t i, double lambda) const {
    return (lambda - lambda_centre[i] - lambda_shift[i]) / lambda_per_length[i];
  }
  /// Whether all crossings up to t are certain to be in front of lambda_max.
  [[nodiscard]] bool is_before(std::size_t i, double t, double lambda_max) const {
    const double far = t * lambda_per_length[i];
    const double room =
        lambda_room * (std::abs(lambda_centre[i]) + std::abs(lambda_shift[i]) + std::abs(far));
    return lambda(i, t) + room < lambda_max;
  }
  [[nodiscard]] LocalLine line(std::size_t i) const {
    return {{point[0][i], point[1][i], point[2][i]},
            {direction[0][i], direction[1][i], direction[2][i]},
            lambda_centre[i],
            lambda_shift[i],
            lambda_per_length[i],
            {clock_start[i], clock_rate[i]}};
  }
  /// One more.
  void add(const LocalLine& line) {
    put(count++, line);
    for (std::size_t i = count; i < padded(); ++i) put(i, line);
  }

 private:
  void put(std::size_t i, const LocalLine& line) {
    for (int axis = 0; axis < 3; ++axis) {
      point[axis][i] = line.point[axis];
      direction[axis][i] = line.direction[axis];
    }
    lambda_centre[i] = line.lambda_centre;
    lambda_shift[i] = line.lambda_shift;
    lambda_per_length[i] = line.lambda_per_length;
    clock_start[i] = line.clock.start;
    clock_rate[i] = line.clock.rate;
  }
};

/// What the lanes need of a PlacedSurface.
struct LinePlacement {
  double centre[3];
  LaneMatrix local_from_rest;
  bool aligned;
};

inline LinePlacement line_placement(const PlacedSurface& surface) {
  LinePlacement result;
  result.aligned = surface.aligned;
  for (int c = 0; c < 3; ++c) {
    result.centre[c] = surface.placement.position()[c];
    for (int r = 0; r < 3; ++r)
      result.local_from_rest.column[c][r] = surface.placement.local_from_rest()[c][r];
  }
  return result;
}

/// local_line() of the rays of `lines`, a padded number of them.
template <class V>
class LocalLineLanes {
 public:
  static void run(const LinePlacement& placement, LocalLines& lines) {
    for (std::size_t k = 0; k < lines.padded(); k += V::width) one(placement, lines, k);
  }

 private:
  struct Parts {
    V value, error;
  };
  static BACKLIGHT_LANES Parts two_sum(V a, V b) {
    const V sum = a + b;
    const V b_part = sum - a;
    return {sum, (a - (sum - b_part)) + (b - b_part)};
  }
  static BACKLIGHT_LANES Parts split(V a) {
    const V scaled = V(134217729.0) * a;
    const V high = scaled - (scaled - a);
    return {high, a - high};
  }
  static BACKLIGHT_LANES Parts two_product(V a, V b, Parts a_split, Parts b_split) {
    const V product = a * b;
    const V error = ((a_split.value * b_split.value - product) + a_split.value * b_split.error +
                     a_split.error * b_split.value) +
                    a_split.error * b_split.error;
    return {product, error};
  }
  static BACKLIGHT_LANES V re_origined(V origin, V centre, V lambda, Parts lambda_split, V direction) {
    const Parts offset = two_sum(origin, -centre);
    const Parts along = two_product(lambda, direction, lambda_split, split(direction));
    const Parts sum = two_sum(offset.value, along.value);
    return sum.value + (sum.error + (offset.error + along.error));
  }

  static BACKLIGHT_LANES LaneVec3<V> load(const double (&from)[3][LocalLines::most], std::size_t k) {
    return {V::load(from[0] + k), V::load(from[1] + k), V::load(from[2] + k)};
  }
  static BACKLIGHT_LANES void store(LaneVec3<V> a, double (&to)[3][LocalLines::most], std::size_t k) {
    a.x.store(to[0] + k);
    a.y.store(to[1] + k);
    a.z.store(to[2] + k);
  }

  static BACKLIGHT_LANES void one(const LinePlacement& placement, LocalLines& lines, std::size_t k) {
    const LaneVec3<V> origin = load(lines.origin, k);
    const LaneVec3<V> n = load(lines.along, k);
    const LaneVec3<V> centre(placement.centre);
    const V inverse_square = V(1.0) / dot(n, n);
    const V inverse_length = sqrt(inverse_square);
    const V lambda = -dot(origin - centre, n) * inverse_square;
    const Parts parts = split(lambda);
    LaneVec3<V> point(re_origined(origin.x, centre.x, lambda, parts, n.x),
                      re_origined(origin.y, centre.y, lambda, parts, n.y),
                      re_origined(origin.z, centre.z, lambda, parts, n.z));
    LaneVec3<V> direction = n;
    V per_length = inverse_length;
    if (!placement.aligned) {
      point = placement.local_from_rest.times(point);
      direction = placement.local_from_rest.times(n);
      per_length = V(1.0) / sqrt(dot(direction, direction));
    }
    const LaneVec3<V> unit(direction.x * per_length, direction.y * per_length, direction.z * per_length);
    const V shift = -dot(point, unit);
    const V rate = V::load(lines.rate + k);
    (V::load(lines.time + k) + (lambda + shift * per_length) * rate).store(lines.clock_start + k);
    (per_length * rate).store(lines.clock_rate + k);
    store(point + shift * unit, lines.point, k);
    store(unit, lines.direction, k);
    lambda.store(lines.lambda_centre + k);
    (shift * per_length).store(lines.lambda_shift + k);
    per_length.store(lines.lambda_per_length + k);
  }
};

}  // namespace backlight
