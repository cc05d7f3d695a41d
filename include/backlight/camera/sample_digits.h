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

}  // namespace backlight
