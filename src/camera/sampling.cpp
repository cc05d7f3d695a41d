#include "backlight/camera/sampling.h"

namespace backlight {
namespace {

// The finaliser of splitmix64 (Steele, Lea & Flood 2014): a bijection that mixes all bits.
std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

std::uint64_t hash(const SampleKey& key) {
  constexpr std::uint64_t step = 0x9e3779b97f4a7c15ULL;
  std::uint64_t h = mix(key.seed + step);
  h = mix(h + step + static_cast<std::uint64_t>(key.image));
  const auto x = static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.x));
  const auto y = static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.y));
  h = mix(h + step + (y << 32U) + x);
  return key.part == 0 ? h : mix(h + step + static_cast<std::uint64_t>(key.part));
}

// The bits in the opposite order.
std::uint32_t reversed(std::uint32_t bits) {
  const auto swap = [&bits](unsigned by, std::uint32_t low) {
    bits = ((bits >> by) & low) | ((bits & low) << by);
  };
  swap(1U, 0x55555555U);
  swap(2U, 0x33333333U);
  swap(4U, 0x0f0f0f0fU);
  swap(8U, 0x00ff00ffU);
  swap(16U, 0x0000ffffU);
  return bits;
}

// Sobol's second dimension, with the digits of the result from the last to the first: Pascal's triangle
// modulo 2, of which each row is the one before added to itself one place on.
std::uint32_t second_dimension(std::uint32_t index) {
  std::uint32_t sum = 0;
  for (std::uint32_t row = 1; index != 0; index >>= 1U, row ^= row << 1U) {
    if ((index & 1U) != 0) sum ^= row;
  }
  return sum;
}

// A bijection in which a bit depends on those below it and the seed alone: with the first digit lowest,
// Owen's nested permutations. Products with even numbers carry only upward.
std::uint32_t permuted(std::uint32_t digits, std::uint32_t seed) {
  digits += seed;
  digits ^= digits * 0x6c50b47cU;
  digits ^= digits * 0xb82f1e52U;
  digits *= (seed >> 16U) | 1U;
  digits ^= digits * 0xc7afe638U;
  digits ^= digits * 0x8d22f6e6U;
  return digits;
}

double fraction(std::uint32_t digits, std::uint32_t seed) {
  return reversed(permuted(digits, seed)) * 0x1p-32;
}

}  // namespace

ImagePoint unit_sample(const SampleKey& key, int index) {
  const std::uint64_t h = hash(key);
  const auto n = static_cast<std::uint32_t>(index);
  // Van der Corput's digits are those of the number itself, the last one first.
  return {fraction(n, static_cast<std::uint32_t>(h)),
          fraction(second_dimension(n), static_cast<std::uint32_t>(h >> 32U))};
}

ImagePoint sample_point(const SampleKey& key, int index, int count) {
  if (count <= 1) return {key.x + 0.5, key.y + 0.5};
  const ImagePoint place = unit_sample(key, index);
  return {key.x + place.x, key.y + place.y};
}

}  // namespace backlight
