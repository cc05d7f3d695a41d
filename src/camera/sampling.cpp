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
  h = mix(h + step + static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.x)));
  return mix(h + step + static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.y)));
}

// 2^64 times the fractional steps 1/g and 1/g², g the plastic number (g³ = g + 1).
constexpr std::uint64_t step_x = 0xc13fa9a902a6328fULL;
constexpr std::uint64_t step_y = 0x91e10da5c79e7b1dULL;

double fraction(std::uint64_t bits) {
  return static_cast<double>(bits >> 11U) * 0x1p-53;
}

}  // namespace

ImagePoint sample_point(const SampleKey& key, int index, int count) {
  if (count <= 1) return {key.x + 0.5, key.y + 0.5};
  const std::uint64_t h = hash(key);
  const auto n = static_cast<std::uint64_t>(index) + 1;
  return {key.x + fraction(h + n * step_x), key.y + fraction(mix(h) + n * step_y)};
}

}  // namespace backlight
