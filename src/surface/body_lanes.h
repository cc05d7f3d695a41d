// Where lines meet boxes that move, over lanes: docs/physics.md equation (28f).
#pragma once

#include "backlight/surface/body_box.h"
#include "closed_forms.h"
#include "local_lines.h"

namespace backlight {

/// Parameters of lines between which something is met; none where in > out.
struct LineStretches {
  alignas(64) double in[LocalLines::most];
  alignas(64) double out[LocalLines::most];
};

/// The parts of lines within an axis-aligned box about `centre`, for a padded number of lines.
template <class V>
void inside_box(const double (&centre)[3], const double (&half)[3], const LocalLines& lines,
                LineStretches& found) {
  for (std::size_t i = 0; i < lines.padded(); i += V::width) {
    LaneStretch<V> stretch;
    for (int k = 0; k < 3; ++k) {
      stretch.narrow_to_slab(V::load(lines.point[k] + i) - V(centre[k]), V::load(lines.direction[k] + i),
                             V(half[k]), 0.0);
    }
    stretch.in.store(found.in + i);
    stretch.out.store(found.out + i);
  }
}

/// Pieces of lines, and the affine forms of the coordinates that bodies rest in, along them: at
/// s = middle + ε half, |ε| <= 1, they are within centre + ε slope ± error.
struct CommonRows {
  static constexpr std::size_t most = LocalLines::most;
  std::size_t count = 0;
  alignas(64) double from[most], to[most];
  alignas(64) double centre[3][most], slope[3][most], error[3][most];
};

/// The part of each piece in which the box may be met; all of it where nothing is known.
template <class V>
void meet_box(const BodyBox& box, const CommonRows& rows, LineStretches& found) {
  constexpr double room = 1.0 + 0x1p-6;  // what is not near a surface has a certain sign at its ends
  for (std::size_t i = 0; i < rows.count; i += V::width) {
    const LaneVec3<V> centre = load3<V>(rows.centre, i) - LaneVec3<V>(box.centre),
                      slope = load3<V>(rows.slope, i), off = load3<V>(rows.error, i);
    const V most(1e300);  // of what is not known: 0 times that is 0
    const LaneVec3<V> error{smaller(off.x, most), smaller(off.y, most), smaller(off.z, most)};
    const LaneVec3<V> size{magnitude(centre.x) + magnitude(slope.x), magnitude(centre.y) + magnitude(slope.y),
                           magnitude(centre.z) + magnitude(slope.z)};
    LaneStretch<V> stretch;
    for (int k = 0; k < 3; ++k) {
      const LaneVec3<V> along(box.axis[k]),
          across(magnitude(along.x), magnitude(along.y), magnitude(along.z));
      const V half = V(room * box.half[k]) + dot(across, error) + V(1e-14) * dot(across, size);
      stretch.narrow_to_slab(dot(along, centre), dot(along, slope), half, 0.0);
    }
    const V from = V::load(rows.from + i), to = V::load(rows.to + i);
    const V middle = V(0.5) * (from + to), length = V(0.5) * (to - from);
    const V in = larger(stretch.in - V(1e-9), V(-1.0)), out = smaller(stretch.out + V(1e-9), V(1.0));
    const typename V::Mask met = in <= out;
    select(met, larger(from, middle + in * length), V(__builtin_inf())).store(found.in + i);
    select(met, smaller(to, middle + out * length), V(-__builtin_inf())).store(found.out + i);
  }
}

}  // namespace backlight
