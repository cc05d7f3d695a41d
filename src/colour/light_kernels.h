// Lights in motion over lanes of points: LightRows::at and Place::film, and ReflectedLight's cubic.
#pragma once

#include "backlight/base/lane_exponential.h"
#include "backlight/colour/spectral_kernels.h"
#include "light_samples.h"
#include "planck.h"
#include "rec709.h"

namespace backlight {

/// Greater powers of e would leave no room for what a strength, a distance and D make of them.
inline constexpr double greatest_log = 600.0;

/// Below, light falls so steeply towards the blue that ReflectedLight does not follow it well from node to
/// node.
inline constexpr double coldest_followed_kelvin = 1000.0;

/// The cubic that has the values and slopes of both ends, `t` of the way.
template <class T, class Number>
BACKLIGHT_LANES T hermite(const T& low, const T& low_slope, const T& high, const T& high_slope, Number t) {
  const Number u = 1.0 - t;
  return u * u * (1.0 + 2.0 * t) * low + t * t * (3.0 - 2.0 * t) * high +
         t * u * (u * low_slope - t * high_slope);
}

template <int N>
struct LightKernelsOf {
  using V = Lanes<N>;
  using V3 = LaneVec3<V>;
  using Mask = LaneMask<N>;
  using I = typename Mask::Vec;
  static constexpr unsigned all_lanes = (1U << N) - 1U;

  static BACKLIGHT_LANES Mask has(const RowRange& range, V x) {
    return (x >= V(range.least)) & (x < V(range.end));
  }

  /// The rows below and above each lane's place.
  struct Between {
    struct Rows {
      V log_scale, log_slope;
      V3 film, film_slope;

      BACKLIGHT_LANES void take(Mask mask, const LightRow& row) {
        log_scale = select(mask, V(row.log_scale), log_scale);
        log_slope = select(mask, V(row.log_slope), log_slope);
        film = select(mask, V3{V(row.film.x), V(row.film.y), V(row.film.z)}, film);
        film_slope =
            select(mask, V3{V(row.film_slope.x), V(row.film_slope.y), V(row.film_slope.z)}, film_slope);
      }
    };
    Rows low, high;
    V step, fraction;

    BACKLIGHT_LANES Between(const RowRange& range, const LightRow* rows, V x, unsigned lanes) {
      const I bits_of_row = (I)x.v >> range.bits_below_row;
      const V below = (typename V::Vec)(bits_of_row << range.bits_below_row);
      step = V((typename V::Vec)((bits_of_row + 1) << range.bits_below_row)) - below;
      fraction = (x - below) / step;
      alignas(64) long long row_of[N];
      __builtin_memcpy(row_of, &bits_of_row, sizeof row_of);
      const auto first =
          static_cast<long long>(__builtin_bit_cast(long long, range.least)) >> range.bits_below_row;
      // Neighbours are mostly between the same two.
      while (lanes != 0) {
        const long long row = row_of[__builtin_ctz(lanes)];
        const Mask same{bits_of_row == I{} + row};
        low.take(same, rows[row - first]);
        high.take(same, rows[row - first + 1]);
        lanes &= ~bits(same);
      }
    }
    [[nodiscard]] BACKLIGHT_LANES V3 film() const {
      return {hermite(low.film.x, step * low.film_slope.x, high.film.x, step * high.film_slope.x, fraction),
              hermite(low.film.y, step * low.film_slope.y, high.film.y, step * high.film_slope.y, fraction),
              hermite(low.film.z, step * low.film_slope.z, high.film.z, step * high.film_slope.z, fraction)};
    }
    [[nodiscard]] BACKLIGHT_LANES V log_scale() const {
      return hermite(low.log_scale, step * low.log_slope, high.log_scale, step * high.log_slope, fraction);
    }
  };

  static std::uint64_t films(const SpectrumForm& f, const LightRow* daylight, const LightRow* bodies,
                             const double* shift, std::uint64_t points, double* const (&film)[4]) {
    using Kind = SpectrumForm::Kind;
    static constexpr double luminance[3] = {rec709::xyz_from_rgb[1][0], rec709::xyz_from_rgb[1][1],
                                            rec709::xyz_from_rgb[1][2]};
    const bool is_body = f.kind == Kind::blackbody;
    if (!is_body && f.kind != Kind::d65 && f.kind != Kind::illuminant) return 0;
    std::uint64_t known = 0;
    for (int i = 0; i < 64; i += N) {
      const unsigned lanes = static_cast<unsigned>(points >> i) & all_lanes;
      if (lanes == 0) continue;
      const V s = V::load(shift + i), square = s * s;
      const V kelvin = V(is_body ? f.c0 : planck::d65_kelvin) * s;
      const unsigned by_day = is_body ? 0 : lanes & bits(has(shifts, s));
      const unsigned by_body =
          lanes & ~by_day & bits(has(temperatures, kelvin) & (kelvin >= V(coldest_followed_kelvin)));
      V3 sum{V(0.0), V(0.0), V(0.0)};
      if (by_day != 0) sum = V(f.scale) * Between(shifts, daylight, s, by_day).film();
      if (by_body != 0) {
        const Between rows(temperatures, bodies, kelvin, by_body);
        const V scale = is_body ? V(f.scale) : V(f.scale) * select(s < V(1.0), V(f.below), V(f.above));
        const V power = rows.log_scale() - V(is_body ? f.c1 : 0.0);
        const V least = select(V(greatest_log) < power, V(greatest_log), power);
        const V factor = scale / (square * square * s) * exponential(least).value();
        sum = select(mask_of_bits<N>(by_body), factor * rows.film(), sum);
      }
      sum.x.store(film[0] + i);
      sum.y.store(film[1] + i);
      sum.z.store(film[2] + i);
      (V(luminance[0]) * sum.x + V(luminance[1]) * sum.y + V(luminance[2]) * sum.z).store(film[3] + i);
      known |= static_cast<std::uint64_t>(by_day | by_body) << i;
    }
    return known;
  }

  /// Of an axis: whether a Doppler factor is between the nodes, or the node itself.
  static BACKLIGHT_LANES Mask is_in(const LightCell::Axis& axis, V at) {
    if (axis.count == 1) return at == V(axis.node[0]);
    return (at > V(axis.node[1])) & (at < V(axis.node[2]));
  }

  /// Lagrange's polynomials.
  static BACKLIGHT_LANES void fill_shares(const LightCell::Axis& axis, V at, V (&share)[LightCell::order]) {
    if (axis.count == 1) {
      share[0] = V(1.0);
      return;
    }
    const V a = at - V(axis.node[0]), b = at - V(axis.node[1]), c = at - V(axis.node[2]),
            d = at - V(axis.node[3]);
    share[0] = b * (c * d) * V(axis.divisor[0]);
    share[1] = a * (c * d) * V(axis.divisor[1]);
    share[2] = a * b * d * V(axis.divisor[2]);
    share[3] = a * b * c * V(axis.divisor[3]);
  }

  template <int count, int lamp_count>
  static BACKLIGHT_LANES V3 sum_of(const LightCell& cell, V doppler, V lamp_doppler) {
    V share[LightCell::order], lamp_share[LightCell::order];
    fill_shares(cell.camera, doppler, share);
    fill_shares(cell.lamp, lamp_doppler, lamp_share);
    const V3 none{V(0.0), V(0.0), V(0.0)};
    V3 sum = none;
    for (int k = 0; k < lamp_count; ++k) {
      V3 along = none;
      for (int i = 0; i < count; ++i) along = along + share[i] * V3(cell.colour[k][i]);
      sum = sum + lamp_share[k] * along;
    }
    return sum;
  }

  static std::uint64_t between_nodes(const LightCell& cell, const double* doppler, const double* lamp_doppler,
                                     const double* factor, std::uint64_t points, double* const (&colour)[3]) {
    constexpr int order = LightCell::order;
    std::uint64_t found = 0;
    for (int i = 0; i < 64; i += N) {
      const unsigned wanted = static_cast<unsigned>(points >> i) & all_lanes;
      if (wanted == 0) continue;
      const V d = V::load(doppler + i), lamp = V::load(lamp_doppler + i);
      const unsigned lanes = wanted & bits(is_in(cell.camera, d) & is_in(cell.lamp, lamp));
      if (lanes == 0) continue;
      found |= static_cast<std::uint64_t>(lanes) << i;
      const bool one = cell.camera.count == 1, one_lamp = cell.lamp.count == 1;
      const V3 sum = one        ? one_lamp ? sum_of<1, 1>(cell, d, lamp) : sum_of<1, order>(cell, d, lamp)
                            : one_lamp ? sum_of<order, 1>(cell, d, lamp)
                                : sum_of<order, order>(cell, d, lamp);
      const V3 all = V::load(factor + i) * sum;
      const Mask mask = mask_of_bits<N>(lanes);
      select(mask, all.x, V::load(colour[0] + i)).store(colour[0] + i);
      select(mask, all.y, V::load(colour[1] + i)).store(colour[1] + i);
      select(mask, all.z, V::load(colour[2] + i)).store(colour[2] + i);
    }
    return found;
  }
};

}  // namespace backlight
