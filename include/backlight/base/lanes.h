// Several doubles at once: one variable of a kernel for as many rays as the machine's registers are wide.
//
// Kernels are templates over the number of lanes. Every operation is one IEEE operation per lane, in the
// order in which it is written (-ffp-contract=off), so that two lanes and four give the same bits, and those
// of one number after the other.
//
// The files that are compiled for a wider instruction set than the rest of the program instantiate these
// templates with a width of their own, and call no other function that is not inlined by force: the linker
// keeps one copy of an inline function, and must not find one that the machine cannot run.
#pragma once

#include <cstddef>

#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#define BACKLIGHT_LANES __attribute__((always_inline)) inline

namespace backlight {

/// The compiler's own vectors of N numbers. (One by one: gcc 12 drops a vector_size that depends on N; and it
/// makes wrong code of vectors of one number, for which there are plain doubles below. A machine without
/// vectors takes two numbers one after the other.)
template <int N>
struct LaneRegister;
template <>
struct LaneRegister<2> {
  typedef double Numbers __attribute__((vector_size(16)));
  typedef long long Integers __attribute__((vector_size(16)));
};
template <>
struct LaneRegister<4> {
  typedef double Numbers __attribute__((vector_size(32)));
  typedef long long Integers __attribute__((vector_size(32)));
};
template <>
struct LaneRegister<8> {
  typedef double Numbers __attribute__((vector_size(64)));
  typedef long long Integers __attribute__((vector_size(64)));
};

/// Yes or no for each lane.
template <int N>
struct LaneMask {
  using Vec = typename LaneRegister<N>::Integers;
  Vec v;

  friend BACKLIGHT_LANES LaneMask operator&(LaneMask a, LaneMask b) { return {a.v & b.v}; }
  friend BACKLIGHT_LANES LaneMask operator|(LaneMask a, LaneMask b) { return {a.v | b.v}; }
  friend BACKLIGHT_LANES LaneMask operator~(LaneMask a) { return {~a.v}; }
};

/// N doubles.
template <int N>
struct Lanes {
  static constexpr int width = N;
  using Mask = LaneMask<N>;
  using Vec = typename LaneRegister<N>::Numbers;
  Vec v;

  Lanes() = default;
  BACKLIGHT_LANES Lanes(Vec all) : v(all) {}
  /// The same in every lane. (0 is subtracted: adding it would turn -0 into 0, and so not be left out.)
  BACKLIGHT_LANES Lanes(double same) : v(same - Vec{}) {}  // NOLINT: a number is one of any lanes

  static BACKLIGHT_LANES Lanes load(const double* from) {
    Lanes r;
    __builtin_memcpy(&r.v, from, sizeof r.v);
    return r;
  }
  BACKLIGHT_LANES void store(double* to) const { __builtin_memcpy(to, &v, sizeof v); }

  friend BACKLIGHT_LANES Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
  friend BACKLIGHT_LANES Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
  friend BACKLIGHT_LANES Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
  friend BACKLIGHT_LANES Lanes operator/(Lanes a, Lanes b) { return a.v / b.v; }
  friend BACKLIGHT_LANES Lanes operator-(Lanes a) { return -a.v; }
  friend BACKLIGHT_LANES Mask operator<(Lanes a, Lanes b) { return {a.v < b.v}; }
  friend BACKLIGHT_LANES Mask operator<=(Lanes a, Lanes b) { return {a.v <= b.v}; }
  friend BACKLIGHT_LANES Mask operator>(Lanes a, Lanes b) { return {a.v > b.v}; }
  friend BACKLIGHT_LANES Mask operator>=(Lanes a, Lanes b) { return {a.v >= b.v}; }
  friend BACKLIGHT_LANES Mask operator==(Lanes a, Lanes b) { return {a.v == b.v}; }
};

/// One lane: a kernel as the law for one ray.
template <>
struct LaneMask<1> {
  bool v;

  friend BACKLIGHT_LANES LaneMask operator&(LaneMask a, LaneMask b) { return {a.v && b.v}; }
  friend BACKLIGHT_LANES LaneMask operator|(LaneMask a, LaneMask b) { return {a.v || b.v}; }
  friend BACKLIGHT_LANES LaneMask operator~(LaneMask a) { return {!a.v}; }
};
template <>
struct Lanes<1> {
  static constexpr int width = 1;
  using Mask = LaneMask<1>;
  double v;

  Lanes() = default;
  BACKLIGHT_LANES Lanes(double number) : v(number) {}  // NOLINT: as of several lanes

  static BACKLIGHT_LANES Lanes load(const double* from) { return *from; }
  BACKLIGHT_LANES void store(double* to) const { *to = v; }

  friend BACKLIGHT_LANES Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
  friend BACKLIGHT_LANES Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
  friend BACKLIGHT_LANES Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
  friend BACKLIGHT_LANES Lanes operator/(Lanes a, Lanes b) { return a.v / b.v; }
  friend BACKLIGHT_LANES Lanes operator-(Lanes a) { return -a.v; }
  friend BACKLIGHT_LANES Mask operator<(Lanes a, Lanes b) { return {a.v < b.v}; }
  friend BACKLIGHT_LANES Mask operator<=(Lanes a, Lanes b) { return {a.v <= b.v}; }
  friend BACKLIGHT_LANES Mask operator>(Lanes a, Lanes b) { return {a.v > b.v}; }
  friend BACKLIGHT_LANES Mask operator>=(Lanes a, Lanes b) { return {a.v >= b.v}; }
  friend BACKLIGHT_LANES Mask operator==(Lanes a, Lanes b) { return {a.v == b.v}; }
};

/// Lane by lane: mask ? a : b.
template <int N>
BACKLIGHT_LANES Lanes<N> select(LaneMask<N> mask, Lanes<N> a, Lanes<N> b) {
  return mask.v ? a.v : b.v;
}

/// Bit i is lane i.
template <int N>
BACKLIGHT_LANES unsigned bits(LaneMask<N> mask) {
  if constexpr (N == 1) return mask.v ? 1U : 0U;
#if defined(__AVX__)
  if constexpr (N == 4) return static_cast<unsigned>(_mm256_movemask_pd((__m256d)mask.v));
#endif
#if defined(__SSE2__)
  if constexpr (N == 2) return static_cast<unsigned>(_mm_movemask_pd((__m128d)mask.v));
#endif
  unsigned all = 0;
  if constexpr (N > 1) {
    for (int i = 0; i < N; ++i) all |= (mask.v[i] != 0 ? 1U : 0U) << i;
  }
  return all;
}

/// Stores the lanes whose bits are set one after the other; what follows them, up to a whole register, may be
/// overwritten.
template <int N>
BACKLIGHT_LANES void store_kept(Lanes<N> a, unsigned keep, double* to) {
#if defined(__AVX512F__)
  if constexpr (N == 8) {
    _mm512_storeu_pd(to, _mm512_maskz_compress_pd(static_cast<__mmask8>(keep), (__m512d)a.v));
    return;
  }
#endif
  for (; keep != 0; keep &= keep - 1) *to++ = a.v[__builtin_ctz(keep)];
}

/// The opposite of bits().
template <int N>
BACKLIGHT_LANES LaneMask<N> mask_of_bits(unsigned all) {
  if constexpr (N == 1) return {(all & 1U) != 0};
  LaneMask<N> mask;
  if constexpr (N > 1) {
    for (int i = 0; i < N; ++i) mask.v[i] = -static_cast<long long>((all >> i) & 1U);
  }
  return mask;
}

template <int N>
BACKLIGHT_LANES Lanes<N> sqrt(Lanes<N> a) {
  if constexpr (N == 1) return __builtin_sqrt(a.v);
#if defined(__AVX512F__)
  if constexpr (N == 8) return (typename Lanes<N>::Vec)_mm512_sqrt_pd((__m512d)a.v);
#endif
#if defined(__AVX__)
  if constexpr (N == 4) return (typename Lanes<N>::Vec)_mm256_sqrt_pd((__m256d)a.v);
#endif
#if defined(__SSE2__)
  if constexpr (N == 2) return (typename Lanes<N>::Vec)_mm_sqrt_pd((__m128d)a.v);
#elif defined(__aarch64__)
  if constexpr (N == 2) return (typename Lanes<N>::Vec)vsqrtq_f64((float64x2_t)a.v);
#endif
  Lanes<N> root;
  if constexpr (N > 1) {
    for (int i = 0; i < N; ++i) root.v[i] = __builtin_sqrt(a.v[i]);
  }
  return root;
}

/// a > b ? a : b, which is b if either is not a number.
template <class V>
BACKLIGHT_LANES V larger(V a, V b) {
#if defined(__AVX512F__)
  if constexpr (V::width == 8) return (typename V::Vec)_mm512_max_pd((__m512d)a.v, (__m512d)b.v);
#endif
#if defined(__AVX__)
  if constexpr (V::width == 4) return (typename V::Vec)_mm256_max_pd((__m256d)a.v, (__m256d)b.v);
#endif
#if defined(__SSE2__)
  if constexpr (V::width == 2) return (typename V::Vec)_mm_max_pd((__m128d)a.v, (__m128d)b.v);
#endif
  return select(a > b, a, b);
}

/// a < b ? a : b, which is b if either is not a number.
template <class V>
BACKLIGHT_LANES V smaller(V a, V b) {
#if defined(__AVX512F__)
  if constexpr (V::width == 8) return (typename V::Vec)_mm512_min_pd((__m512d)a.v, (__m512d)b.v);
#endif
#if defined(__AVX__)
  if constexpr (V::width == 4) return (typename V::Vec)_mm256_min_pd((__m256d)a.v, (__m256d)b.v);
#endif
#if defined(__SSE2__)
  if constexpr (V::width == 2) return (typename V::Vec)_mm_min_pd((__m128d)a.v, (__m128d)b.v);
#endif
  return select(a < b, a, b);
}

template <class V>
BACKLIGHT_LANES V magnitude(V a) {
  return larger(a, -a);
}

/// The least and the largest of all lanes; not to be asked of what is not a number.
template <int N>
BACKLIGHT_LANES double least_of(Lanes<N> a) {
  if constexpr (N == 1) {
    return a.v;
  } else if constexpr (N == 2) {
    return a.v[0] < a.v[1] ? a.v[0] : a.v[1];
  } else if constexpr (N == 4) {
    return least_of(smaller(Lanes<2>(__builtin_shufflevector(a.v, a.v, 0, 1)),
                            Lanes<2>(__builtin_shufflevector(a.v, a.v, 2, 3))));
  } else {
    return least_of(smaller(Lanes<4>(__builtin_shufflevector(a.v, a.v, 0, 1, 2, 3)),
                            Lanes<4>(__builtin_shufflevector(a.v, a.v, 4, 5, 6, 7))));
  }
}
template <int N>
BACKLIGHT_LANES double most_of(Lanes<N> a) {
  return -least_of(-a);
}

/// The most of each of as many registers as they have lanes, that of the i-th in lane i.
template <int N>
BACKLIGHT_LANES Lanes<N> most_of_each(const Lanes<N> (&rows)[N]) {
  // Pairs of lanes, of pairs of registers, until each lane is of all lanes of one register.
  if constexpr (N == 1) {
    return rows[0];
  } else if constexpr (N == 2) {
    return larger(Lanes<N>(__builtin_shufflevector(rows[0].v, rows[1].v, 0, 2)),
                  Lanes<N>(__builtin_shufflevector(rows[0].v, rows[1].v, 1, 3)));
  } else if constexpr (N == 4) {
    Lanes<N> pairs[2];
    for (int i = 0; i < 2; ++i) {
      const auto a = rows[2 * i].v, b = rows[2 * i + 1].v;
      pairs[i] = larger(Lanes<N>(__builtin_shufflevector(a, b, 0, 4, 2, 6)),
                        Lanes<N>(__builtin_shufflevector(a, b, 1, 5, 3, 7)));
    }
    const auto a = pairs[0].v, b = pairs[1].v;
    return larger(Lanes<N>(__builtin_shufflevector(a, b, 0, 1, 4, 5)),
                  Lanes<N>(__builtin_shufflevector(a, b, 2, 3, 6, 7)));
  } else {
    Lanes<N> pairs[4], fours[2];
    for (int i = 0; i < 4; ++i) {
      const auto a = rows[2 * i].v, b = rows[2 * i + 1].v;
      pairs[i] = larger(Lanes<N>(__builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14)),
                        Lanes<N>(__builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15)));
    }
    for (int i = 0; i < 2; ++i) {
      const auto a = pairs[2 * i].v, b = pairs[2 * i + 1].v;
      fours[i] = larger(Lanes<N>(__builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13)),
                        Lanes<N>(__builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15)));
    }
    const auto a = fours[0].v, b = fours[1].v;
    return larger(Lanes<N>(__builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11)),
                  Lanes<N>(__builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15)));
  }
}

/// Three coordinates of N things.
template <class V>
struct LaneVec3 {
  V x, y, z;

  LaneVec3() = default;
  BACKLIGHT_LANES LaneVec3(V a, V b, V c) : x(a), y(b), z(c) {}
  explicit BACKLIGHT_LANES LaneVec3(const double (&same)[3]) : x(same[0]), y(same[1]), z(same[2]) {}

  friend BACKLIGHT_LANES LaneVec3 operator+(LaneVec3 a, LaneVec3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend BACKLIGHT_LANES LaneVec3 operator-(LaneVec3 a, LaneVec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend BACKLIGHT_LANES LaneVec3 operator*(V s, LaneVec3 a) { return {s * a.x, s * a.y, s * a.z}; }
  friend BACKLIGHT_LANES LaneVec3 operator/(LaneVec3 a, V s) { return {a.x / s, a.y / s, a.z / s}; }
  friend BACKLIGHT_LANES LaneVec3 operator-(LaneVec3 a) { return {-a.x, -a.y, -a.z}; }
};

/// The sum from left to right, as GLM's.
template <class V>
BACKLIGHT_LANES V dot(LaneVec3<V> a, LaneVec3<V> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class V>
BACKLIGHT_LANES V length(LaneVec3<V> a) {
  return sqrt(dot(a, a));
}

template <class V>
BACKLIGHT_LANES LaneVec3<V> select(typename V::Mask mask, LaneVec3<V> a, LaneVec3<V> b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// From and to the coordinates of `count` things, those from `at` on.
template <class V, std::size_t count, class Index>
BACKLIGHT_LANES LaneVec3<V> load3(const double (&from)[3][count], Index at) {
  return {V::load(from[0] + at), V::load(from[1] + at), V::load(from[2] + at)};
}
template <class V, std::size_t count, class Index>
BACKLIGHT_LANES void store3(LaneVec3<V> a, double (&to)[3][count], Index at) {
  a.x.store(to[0] + at);
  a.y.store(to[1] + at);
  a.z.store(to[2] + at);
}

/// A 3x3 matrix, the same in every lane: three columns, as GLM's.
struct LaneMatrix {
  double column[3][3];

  template <class V>
  BACKLIGHT_LANES LaneVec3<V> times(LaneVec3<V> a) const {
    return {V(column[0][0]) * a.x + V(column[1][0]) * a.y + V(column[2][0]) * a.z,
            V(column[0][1]) * a.x + V(column[1][1]) * a.y + V(column[2][1]) * a.z,
            V(column[0][2]) * a.x + V(column[1][2]) * a.y + V(column[2][2]) * a.z};
  }
  template <class V>
  BACKLIGHT_LANES LaneVec3<V> transposed_times(LaneVec3<V> a) const {
    return {V(column[0][0]) * a.x + V(column[0][1]) * a.y + V(column[0][2]) * a.z,
            V(column[1][0]) * a.x + V(column[1][1]) * a.y + V(column[1][2]) * a.z,
            V(column[2][0]) * a.x + V(column[2][1]) * a.y + V(column[2][2]) * a.z};
  }
};

}  // namespace backlight

#include "backlight/base/lanes_avx512.h"
