#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "read_model.h"

namespace backlight::models {
namespace {

constexpr std::uint32_t empty = std::numeric_limits<std::uint32_t>::max();

std::uint64_t mix(std::uint64_t hash, double value) {
  hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15U;
  return hash ^ (hash >> 29);
}

std::uint64_t hash_of(const double* place, const double* normal, const double* texture) {
  std::uint64_t hash = 0;
  for (int k = 0; k < 3; ++k) hash = mix(mix(hash, place[k]), normal[k]);
  return mix(mix(hash, texture[0]), texture[1]);
}

}  // namespace

void check_finite(const Corner& corner) {
  double sum = 0.0;
  for (const double x : corner.place) sum += 0.0 * x;
  for (const double x : corner.normal) sum += 0.0 * x;
  for (const double x : corner.texture) sum += 0.0 * x;
  if (std::isnan(sum)) throw std::runtime_error("it has a number that is not finite");
}

bool CornerTable::is(std::uint32_t number, const Corner& corner) const {
  const std::size_t at = 3 * std::size_t{number};
  for (std::size_t k = 0; k < 3; ++k) {
    if (places[at + k] != corner.place[k] || normals[at + k] != corner.normal[k]) return false;
  }
  return texture[2 * std::size_t{number}] == corner.texture[0] &&
         texture[2 * std::size_t{number} + 1] == corner.texture[1];
}

void CornerTable::grow() {
  slots_.assign(slots_.empty() ? 1024 : 2 * slots_.size(), empty);
  for (std::uint32_t number = 0; number < size(); ++number) {
    const std::size_t at = 3 * std::size_t{number};
    std::size_t slot = hash_of(&places[at], &normals[at], &texture[2 * std::size_t{number}]);
    while (slots_[slot & (slots_.size() - 1)] != empty) ++slot;
    slots_[slot & (slots_.size() - 1)] = number;
  }
}

std::uint32_t CornerTable::add(const Corner& given) {
  check_finite(given);
  Corner corner = given;  // of zeros only the positive one
  for (double& x : corner.place) x += 0.0;
  for (double& x : corner.normal) x += 0.0;
  for (double& x : corner.texture) x += 0.0;
  if (2 * size() >= slots_.size()) grow();
  std::size_t slot = hash_of(corner.place.data(), corner.normal.data(), corner.texture.data());
  for (;; ++slot) {
    std::uint32_t& number = slots_[slot & (slots_.size() - 1)];
    if (number == empty) {
      number = static_cast<std::uint32_t>(size());
      places.insert(places.end(), corner.place.begin(), corner.place.end());
      normals.insert(normals.end(), corner.normal.begin(), corner.normal.end());
      texture.insert(texture.end(), corner.texture.begin(), corner.texture.end());
      return number;
    }
    if (is(number, corner)) return number;
  }
}

}  // namespace backlight::models
