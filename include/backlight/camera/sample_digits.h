// The steps of a sample's position, of one number or of vectors of the compiler's: the same bits.
#pragma once

#include <cstdint>

#include "backlight/base/lanes.h"

namespace backlight {

/// What the samples with one index of all pixels of an image have in common.
struct SampleRow {
  std::uint64_t hash;           ///< of the seed and the image
  std::uint32_t first, second;  ///< digits in Sobol's two dimensions, with the last one highest
};

inline constexpr std::uint64_t hash_step = 0x9e3779b97f4a7c15ULL;

/// The finaliser of splitmix64 (Steele, Lea & Flood 2014): a bijection that mixes all bits.
template <class Word>
BACKLIGHT_LANES Word mixed(Word z) {
  z = (z ^ (z >> 30U)) * std::uint64_t{0xbf58476d1ce4e5b9};
  z = (z ^ (z >> 27U)) * std::uint64_t{0x94d049bb133111eb};
  return z ^ (z >> 31U);
}

/// A bijection in which a bit depends on those below it and the seed alone: with the first digit lowest,
/// Owen's nested permutations. Products with even numbers carry only upward.
template <class Word>
BACKLIGHT_LANES Word permuted(Word digits, Word seed) {
  digits += seed;
  digits ^= digits * 0x6c50b47cU;
  digits ^= digits * 0xb82f1e52U;
  digits *= (seed >> 16U) | 1U;
  digits ^= digits * 0xc7afe638U;
  digits ^= digits * 0x8d22f6e6U;
  return digits;
}

/// The bits in the opposite order.
template <class Word>
BACKLIGHT_LANES Word reversed(Word bits) {
  bits = ((bits >> 1U) & 0x55555555U) | ((bits & 0x55555555U) << 1U);
  bits = ((bits >> 2U) & 0x33333333U) | ((bits & 0x33333333U) << 2U);
  bits = ((bits >> 4U) & 0x0f0f0f0fU) | ((bits & 0x0f0f0f0fU) << 4U);
  bits = ((bits >> 8U) & 0x00ff00ffU) | ((bits & 0x00ff00ffU) << 8U);
  return (bits >> 16U) | (bits << 16U);
}

/// Words of 64 bits for each lane, and of 32.
template <int N>
struct Digits;
template <>
struct Digits<2> {
  typedef std::uint64_t Word __attribute__((vector_size(16)));
  typedef std::uint32_t Half __attribute__((vector_size(8)));
};
template <>
struct Digits<4> {
  typedef std::uint64_t Word __attribute__((vector_size(32)));
  typedef std::uint32_t Half __attribute__((vector_size(16)));
};
template <>
struct Digits<8> {
  typedef std::uint64_t Word __attribute__((vector_size(64)));
  typedef std::uint32_t Half __attribute__((vector_size(32)));
};

/// Whole numbers as doubles, without a conversion.
template <int N>
BACKLIGHT_LANES Lanes<N> number(typename Digits<N>::Half whole) {
  using Word = typename Digits<N>::Word;
  const Word bits = __builtin_convertvector(whole, Word) + std::uint64_t{0x4330000000000000};
  return Lanes<N>((typename Lanes<N>::Vec)bits) - Lanes<N>(0x1p52);
}

/// sample_point() of N pixels, of several samples each.
template <int N>
BACKLIGHT_LANES void sample_points(const SampleRow& row, const int* column, const int* line, double* x,
                                   double* y) {
  using Word = typename Digits<N>::Word;
  using Half = typename Digits<N>::Half;
  Half across, down;
  __builtin_memcpy(&across, column, sizeof across);
  __builtin_memcpy(&down, line, sizeof down);
  const Word pixel = (__builtin_convertvector(down, Word) << 32U) + __builtin_convertvector(across, Word);
  const Word hash = mixed(row.hash + hash_step + pixel);
  const Half first = reversed(permuted(Half{} + row.first, __builtin_convertvector(hash, Half)));
  const Half second = reversed(permuted(Half{} + row.second, __builtin_convertvector(hash >> 32U, Half)));
  (number<N>(across) + number<N>(first) * Lanes<N>(0x1p-32)).store(x);
  (number<N>(down) + number<N>(second) * Lanes<N>(0x1p-32)).store(y);
}

}  // namespace backlight
