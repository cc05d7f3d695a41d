#include "backlight/camera/sampling.h"

namespace backlight {
namespace {

// Sobol's second dimension, with the digits of the result from the last to the first: Pascal's triangle
// modulo 2, of which each row is the one before added to itself one place on.
std::uint32_t second_dimension(std::uint32_t index) {
  std::uint32_t sum = 0;
  for (std::uint32_t row = 1; index != 0; index >>= 1U, row ^= row << 1U) {
    if ((index & 1U) != 0) sum ^= row;
  }
  return sum;
}

double fraction(std::uint32_t digits, std::uint32_t seed) {
  return reversed(permuted(digits, seed)) * 0x1p-32;
}

}  // namespace

SampleRow sample_row(std::uint64_t seed, std::int64_t image, int index) {
  const auto n = static_cast<std::uint32_t>(index);
  // Van der Corput's digits are those of the number itself, the last one first.
  return {mixed(mixed(seed + hash_step) + hash_step + static_cast<std::uint64_t>(image)), n,
          second_dimension(n)};
}

ImagePoint unit_sample(const SampleKey& key, int index) {
  const SampleRow row = sample_row(key.seed, key.image, index);
  const auto x = static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.x));
  const auto y = static_cast<std::uint64_t>(static_cast<std::uint32_t>(key.y));
  std::uint64_t h = mixed(row.hash + hash_step + (y << 32U) + x);
  if (key.part != 0) h = mixed(h + hash_step + static_cast<std::uint64_t>(key.part));
  return {fraction(row.first, static_cast<std::uint32_t>(h)),
          fraction(row.second, static_cast<std::uint32_t>(h >> 32U))};
}

ImagePoint sample_point(const SampleKey& key, int index, int count) {
  if (count <= 1) return {key.x + 0.5, key.y + 0.5};
  const ImagePoint place = unit_sample(key, index);
  return {key.x + place.x, key.y + place.y};
}

}  // namespace backlight
