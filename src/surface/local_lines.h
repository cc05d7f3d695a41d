// Many rays brought next to one surface at once: local_line() over lanes, with the same bits.
#pragma once

#include <cmath>
#include <cstddef>

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

/// local_line() of the rays of `lines`, a padded number of them.
template <class V>
void bring_lines(const LaneSurface& surface, LocalLines& lines) {
  for (std::size_t k = 0; k < lines.padded(); k += V::width) {
    const LaneLine<V> line = lane_line<V>(surface, {load3<V>(lines.origin, k), load3<V>(lines.along, k)});
    const V rate = V::load(lines.rate + k);
    (V::load(lines.time + k) + (line.lambda_centre + line.lambda_shift) * rate).store(lines.clock_start + k);
    (line.lambda_per_length * rate).store(lines.clock_rate + k);
    store3(line.point, lines.point, k);
    store3(line.direction, lines.direction, k);
    line.lambda_centre.store(lines.lambda_centre + k);
    line.lambda_shift.store(lines.lambda_shift + k);
    line.lambda_per_length.store(lines.lambda_per_length + k);
  }
}

}  // namespace backlight
