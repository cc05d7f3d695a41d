// The kernels of colour/spectral_kernels.h for any number of lanes. docs/colour.md has the spectra.
#pragma once

#include "backlight/base/lane_exponential.h"
#include "backlight/base/lane_power.h"
#include "backlight/colour/spectral_kernels.h"
#include "cie_tables.h"
#include "light_kernels.h"
#include "planck.h"

// On a lambda of a kernel: see base/lanes.h.
#define BACKLIGHT_INLINED __attribute__((always_inline))

namespace backlight {

/// D65 from 360 to 830 nm by straight lines: value and rise over the next 5 nm; the last has none.
struct D65Lines {
  double line[95][2]{};
};

constexpr D65Lines make_d65_lines() {
  D65Lines lines;
  for (std::size_t i = 0; i < 95; ++i) {
    lines.line[i][0] = 0.01 * cie::d65_by_5_nm[i];
    if (i < 94) lines.line[i][1] = 0.01 * cie::d65_by_5_nm[i + 1] - lines.line[i][0];
  }
  return lines;
}

inline constexpr D65Lines d65_lines = make_d65_lines();

/// A value and its rise for each lane.
template <int N>
struct LanePairs {
  Lanes<N> value;
  Lanes<N> rise;
};

/// table[index[i]] for each lane i: two numbers that lie side by side take one load, where a gather takes
/// two.
template <int N>
BACKLIGHT_LANES LanePairs<N> load_pairs(const double (*table)[2], const long long (&index)[N]) {
#if defined(__AVX512F__)
  if constexpr (N == 8) {
    const auto join = [&](int i) BACKLIGHT_INLINED {
      const __m256d low = _mm256_set_m128d(_mm_loadu_pd(table[index[i + 2]]), _mm_loadu_pd(table[index[i]]));
      const __m256d high =
          _mm256_set_m128d(_mm_loadu_pd(table[index[i + 6]]), _mm_loadu_pd(table[index[i + 4]]));
      return _mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1);
    };
    const __m512d even = join(0), odd = join(1);
    return {(typename Lanes<N>::Vec)_mm512_unpacklo_pd(even, odd),
            (typename Lanes<N>::Vec)_mm512_unpackhi_pd(even, odd)};
  }
#endif
#if defined(__AVX__)
  if constexpr (N == 4) {
    const __m256d even = _mm256_set_m128d(_mm_loadu_pd(table[index[2]]), _mm_loadu_pd(table[index[0]]));
    const __m256d odd = _mm256_set_m128d(_mm_loadu_pd(table[index[3]]), _mm_loadu_pd(table[index[1]]));
    return {(typename Lanes<N>::Vec)_mm256_unpacklo_pd(even, odd),
            (typename Lanes<N>::Vec)_mm256_unpackhi_pd(even, odd)};
  }
#endif
  LanePairs<N> pairs;
  for (int i = 0; i < N; ++i) {
    pairs.value.v[i] = table[index[i]][0];
    pairs.rise.v[i] = table[index[i]][1];
  }
  return pairs;
}

template <int N>
struct FloatRegister;
template <>
struct FloatRegister<2> {
  using Vec = float __attribute__((vector_size(8)));
};
template <>
struct FloatRegister<4> {
  using Vec = float __attribute__((vector_size(16)));
};

template <int N>
struct SpectralKernelsOf {
  using V = Lanes<N>;
  using Mask = LaneMask<N>;
  using I = typename Mask::Vec;

  static constexpr double largest = 1.7976931348623157e308;
  static constexpr double first = cie::first_nm;
  static constexpr double last = cie::last_nm;

  static BACKLIGHT_LANES V clamped(V nm) {
    const V above = select(nm < V(first), V(first), nm);
    return select(V(last) < above, V(last), above);
  }

  static BACKLIGHT_LANES V sigmoid(const SpectrumForm& f, V nm) {
    const V l = clamped(nm);
    const V x = (V(f.c0) * l + V(f.c1)) * l + V(f.c2);
    return V(f.middle) + V(f.half) * x / sqrt(V(1.0) + x * x);
  }

  static BACKLIGHT_LANES V levelled(const SpectrumForm& f, V nm) {
    const V inside = sigmoid(f, nm);
    const V blend = V(1.0 / 60.0);
    const V below = (V(first) - nm) * blend;
    const V above = (nm - V(last)) * blend;
    const V to_uv = select(below < V(1.0), below, V(1.0));
    const V to_ir = select(above < V(1.0), above, V(1.0));
    const V value = select(nm < V(first), inside + to_uv * (V(f.below) - inside), inside);
    return select(nm > V(last), inside + to_ir * (V(f.above) - inside), value);
  }

  static BACKLIGHT_LANES V at_most(V value) { return select(value < V(largest), value, V(largest)); }

  /// nm^-5 / (exp(x) - 1) times factor; 0 where that is below the smallest double.
  static BACKLIGHT_LANES V planck(V nm, V x, V boltzmann, V one_less) {
    const V nm2 = nm * nm;
    const V value = boltzmann / (nm2 * nm2 * nm * one_less);
    return select((boltzmann > V(0.0)) & (x > V(0.0)), at_most(value), V(0.0));
  }

  static BACKLIGHT_LANES V blackbody(const SpectrumForm& f, V nm) {
    const V x = V(planck::second_constant_nm_kelvin) / (nm * V(f.c0));
    const V boltzmann = exponential(-x - V(f.c1)).value();
    return at_most(V(f.scale) * planck(nm, x, boltzmann, exponential(-x).complement()));
  }

  static BACKLIGHT_LANES V d65(const SpectrumForm& f, V nm) {
    // The nearest whole number to half a cell before is the cell's own, or at a joint one of its neighbours'.
    const V position = (clamped(nm) - V(first)) * V(0.2);
    const V shifted = (position - V(0.5)) + V(0x1.8p52);
    alignas(64) long long cell[N];
    const I whole = (I)shifted.v - (I)V(0x1.8p52).v;
    __builtin_memcpy(cell, &whole, sizeof cell);
    const LanePairs<N> line = load_pairs<N>(d65_lines.line, cell);
    const V table = line.value + (position - (shifted - V(0x1.8p52))) * line.rise;
    const Mask inside = (nm >= V(first)) & (nm <= V(last));
    if (bits(~inside) == 0) return table;
    const V x = V(planck::second_constant_nm_kelvin / planck::d65_kelvin) / nm;
    const LaneExponential<N> e = exponential(-x);
    const V factor = select(nm < V(first), V(f.below), V(f.above));
    return select(inside, table, planck(nm, x, factor * e.value(), e.complement()));
  }

  template <class F>
  static BACKLIGHT_LANES void for_each(const double* nm, int n, double* out, const F& value_at) {
    int i = 0;
    for (; i + N <= n; i += N) value_at(V::load(nm + i)).store(out + i);
    if (i >= n) return;
    double at[N], value[N];
    for (int k = 0; k < N; ++k) at[k] = nm[i + k < n ? i + k : n - 1];
    value_at(V::load(at)).store(value);
    for (int k = 0; i + k < n; ++k) out[i + k] = value[k];
  }

  static void evaluate(const SpectrumForm& f, const double* nm, int n, double* out) {
    const V scale = f.scale;
    switch (f.kind) {
      case SpectrumForm::Kind::constant:
        return for_each(nm, n, out, [&](V) { return scale; });
      case SpectrumForm::Kind::sigmoid:
        if (f.levelled) return for_each(nm, n, out, [&](V at) { return scale * levelled(f, at); });
        return for_each(nm, n, out, [&](V at) { return scale * sigmoid(f, at); });
      case SpectrumForm::Kind::d65:
        return for_each(nm, n, out, [&](V at) { return scale * d65(f, at); });
      case SpectrumForm::Kind::illuminant:
        return for_each(nm, n, out, [&](V at) { return scale * (sigmoid(f, at) * d65(f, at)); });
      case SpectrumForm::Kind::blackbody:
        return for_each(nm, n, out, [&](V at) { return blackbody(f, at); });
      case SpectrumForm::Kind::tabulated:
        return;
    }
  }

  static void raise(double exponent, int n, double* share) {
    for_each(share, n, share,
             [&](V base) { return select(base > V(0.0), power(base, V(exponent)), V(0.0)); });
  }

  static constexpr int block = 8;  ///< terms of which each has a sum of its own
  static constexpr int parts = block / N;

  /// Sums over terms, each in `block` parts.
  template <int sums>
  struct Parts {
    V of[sums][parts];

    BACKLIGHT_LANES Parts() {
      for (auto& sum : of) {
        for (V& part : sum) part = 0.0;
      }
    }
    BACKLIGHT_LANES double total(int i) const {
      double s[block];
      for (int k = 0; k < parts; ++k) of[i][k].store(s + k * N);
      return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
    }
  };

  /// term(k, load) for the k-th part of each block; load(from) has its numbers, and 0 beyond n.
  template <class Term>
  static BACKLIGHT_LANES void for_parts(int n, const Term& term) {
    int i = 0;
    for (; i + block <= n; i += block) {
      for (int k = 0; k < parts; ++k) {
        term(k, [&](const double* from) BACKLIGHT_INLINED { return V::load(from + i + k * N); });
      }
    }
    for (int k = 0; k < parts && i + k * N < n; ++k) {
      term(k, [&](const double* from) BACKLIGHT_INLINED {
        double some[N];
        for (int lane = 0; lane < N; ++lane) {
          const int at = i + k * N + lane;
          some[lane] = at < n ? from[at] : 0.0;
        }
        return V::load(some);
      });
    }
  }

  static void film(const double* const (&weights)[3], const double* a, const double* b, int n,
                   double (&colour)[3]) {
    Parts<3> sum;
    for_parts(n, [&](int k, const auto& load) BACKLIGHT_INLINED {
      V x = load(a);
      if (b != nullptr) x = x * load(b);
      for (int c = 0; c < 3; ++c) sum.of[c][k] = sum.of[c][k] + x * load(weights[c]);
    });
    for (int c = 0; c < 3; ++c) colour[c] = sum.total(c);
  }

  static void film_between(const double* const (&weights)[4][3], const double* share, const double* a,
                           const double* b, int n, double (&colour)[3]) {
    Parts<3> sum;
    for_parts(n, [&](int k, const auto& load) BACKLIGHT_INLINED {
      V x = load(a);
      if (b != nullptr) x = x * load(b);
      for (int c = 0; c < 3; ++c) {
        const V low = V(share[0]) * load(weights[0][c]) + V(share[1]) * load(weights[1][c]);
        const V high = V(share[2]) * load(weights[2][c]) + V(share[3]) * load(weights[3][c]);
        sum.of[c][k] = sum.of[c][k] + x * (low + high);
      }
    });
    for (int c = 0; c < 3; ++c) colour[c] = sum.total(c);
  }

  static void film_and_slopes(const SpectrumForm& f, const double* nm, const double* t,
                              const double* const (&weights)[3], int n, double (&sums)[4][3]) {
    Parts<12> sum;
    for_parts(n, [&](int k, const auto& load) BACKLIGHT_INLINED {
      const V l = load(nm), at = load(t);
      const V x = (V(f.c0) * l + V(f.c1)) * l + V(f.c2);
      const V q = V(1.0) / sqrt(V(1.0) + x * x);
      const V value = V(f.middle) + V(f.half) * x * q;
      const V slope = V(f.half) * q * q * q;
      const V factor[4] = {value, slope * at * at, slope * at, slope};
      for (int c = 0; c < 3; ++c) {
        const V weight = load(weights[c]);
        for (int j = 0; j < 4; ++j) sum.of[3 * j + c][k] = sum.of[3 * j + c][k] + factor[j] * weight;
      }
    });
    for (int j = 0; j < 4; ++j) {
      for (int c = 0; c < 3; ++c) sums[j][c] = sum.total(3 * j + c);
    }
  }

  /// Red, green, blue and nothing.
  struct Channels {
    static constexpr int width = N < 4 ? N : 4;
    Lanes<width> of[4 / width];

    static BACKLIGHT_LANES Channels load(const double* from) {
      Channels r;
      for (int i = 0; i < 4 / width; ++i) r.of[i] = Lanes<width>::load(from + i * width);
      return r;
    }
    static BACKLIGHT_LANES Channels none() {
      Channels r;
      for (auto& part : r.of) part = 0.0;
      return r;
    }
    BACKLIGHT_LANES void store(double* to) const {
      for (int i = 0; i < 4 / width; ++i) of[i].store(to + i * width);
    }
    /// Three of them.
    BACKLIGHT_LANES void store_rounded(float* to) const {
      using Floats = typename FloatRegister<width>::Vec;
      float all[4];
      for (int i = 0; i < 4 / width; ++i) {
        const Floats rounded = __builtin_convertvector(of[i].v, Floats);
        __builtin_memcpy(all + i * width, &rounded, sizeof rounded);
      }
      __builtin_memcpy(to, all, 3 * sizeof(float));
    }
    friend BACKLIGHT_LANES Channels operator+(const Channels& a, const Channels& b) {
      Channels r;
      for (int i = 0; i < 4 / width; ++i) r.of[i] = a.of[i] + b.of[i];
      return r;
    }
    friend BACKLIGHT_LANES Channels operator*(double factor, const Channels& a) {
      Channels r;
      for (int i = 0; i < 4 / width; ++i) r.of[i] = Lanes<width>(factor) * a.of[i];
      return r;
    }
    friend BACKLIGHT_LANES Channels operator-(const Channels& a, const Channels& b) {
      Channels r;
      for (int i = 0; i < 4 / width; ++i) r.of[i] = a.of[i] - b.of[i];
      return r;
    }
  };

  /// What each node's value adds by itself, and what its curvature does: four numbers each.
  static BACKLIGHT_LANES void gather_shares(const SplineForm& f, const double* light, double* value,
                                            double* curvature) {
    Channels value_before = Channels::none(), curvature_before = Channels::none();
    int i = 0;
    for (int node = 0; node + 1 < f.count; ++node) {
      Channels low = Channels::none(), high = low, low_bend = low, high_bend = low;
      for (; i < f.nodes[node].samples_end; ++i) {
        const auto& share = f.samples[i].share;
        low = low + light[i] * Channels::load(share[0]);
        high = high + light[i] * Channels::load(share[1]);
        low_bend = low_bend + light[i] * Channels::load(share[2]);
        high_bend = high_bend + light[i] * Channels::load(share[3]);
      }
      (value_before + low).store(value + 4 * node);
      (curvature_before + low_bend).store(curvature + 4 * node);
      value_before = high;
      curvature_before = high_bend;
    }
    value_before.store(value + 4 * (f.count - 1));
  }

  /// Curvatures are linear in the values: their part goes back to these by the transposed equations.
  static BACKLIGHT_LANES void add_curvatures(const SplineForm& f, double* curvature, double* value) {
    Channels reduced = Channels::none();
    for (int i = 1; i + 1 < f.count; ++i) {
      const SplineForm::Node& node = f.nodes[i];
      reduced = node.pivot * Channels::load(curvature + 4 * i) - node.lower * reduced;
      reduced.store(curvature + 4 * i);
    }
    Channels above = Channels::none(), bend_above = Channels::none();
    for (int i = f.count - 1; i > 0; --i) {
      const SplineForm::Node& below = f.nodes[i - 1];
      const Channels here =
          i > 1 ? Channels::load(curvature + 4 * (i - 1)) - below.upper * above : Channels::none();
      const Channels bend = below.bend * (above - here);
      (Channels::load(value + 4 * i) + (bend_above - bend)).store(value + 4 * i);
      above = here;
      bend_above = bend;
    }
    (Channels::load(value) + bend_above).store(value);
  }

  static void spline_weights(const SplineForm& f, const double* light, double* work,
                             double* const (&weights)[3], float* left_out) {
    double* const value = work;
    gather_shares(f, light, value, work + 4 * f.count);
    add_curvatures(f, work + 4 * f.count, value);
    for (int i = 0; i < f.count; ++i) {
      for (int c = 0; c < 3; ++c) weights[c][i] = value[4 * i + c];
    }
    if (left_out == nullptr) return;
    // From the long end: sums of what is beyond k, the samples' less the spline's weights, and their moments.
    Channels sum = Channels::none(), moment = Channels::none();
    int node = f.count;
    for (int i = cie::sample_count; i-- > 0;) {
      const double k = cie::first_nm + static_cast<double>(i);
      for (; node > 0 && f.nm[node - 1] > k; --node) {
        const Channels w = Channels::load(value + 4 * (node - 1));
        sum = sum - w;
        moment = moment - f.nm[node - 1] * w;
      }
      (moment - k * sum).store_rounded(left_out + 3 * i);
      const Channels here = light[i] * Channels::load(f.film_weights[i]);
      sum = sum + here;
      moment = moment + k * here;
    }
  }

  static constexpr SpectralKernels table(const char* name) {
    using Lights = LightKernelsOf<N>;
    return {name,
            N,
            evaluate,
            raise,
            film,
            film_between,
            film_and_slopes,
            spline_weights,
            Lights::films,
            Lights::between_nodes};
  }
};

}  // namespace backlight
