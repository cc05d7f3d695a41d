#include "backlight/colour/upsampling.h"

#include "sigmoid_fit.h"
#include "upsampling_grid.h"

namespace backlight {
namespace {

namespace grid = upsampling_grid;

// A place between two neighbouring nodes.
struct Place {
  std::size_t node;
  double fraction;
};

Place place_of_brightness(double z) {
  const auto last_cell = grid::brightness.end() - 1;
  const auto above = std::upper_bound(grid::brightness.begin() + 1, last_cell, z);
  const double low = *(above - 1), high = *above;
  return {static_cast<std::size_t>(above - 1 - grid::brightness.begin()),
          std::max(0.0, (z - low) / (high - low))};
}

Place place_of_ratio(double ratio) {
  const double position = std::sqrt(ratio) * (grid::ratio_nodes - 1);
  const auto node = std::min(static_cast<std::size_t>(position), grid::ratio_nodes - 2);
  return {node, position - static_cast<double>(node)};
}

// Interpolates the stored coefficients in the eight nodes around a place.
Vec3 interpolate(std::size_t largest, const Place& z, const Place& third, const Place& second) {
  Vec3 sum{0.0};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t i = corner & 1, j = (corner >> 1) & 1, k = corner >> 2;
    const double weight = (i ? second.fraction : 1.0 - second.fraction) *
                          (j ? third.fraction : 1.0 - third.fraction) * (k ? z.fraction : 1.0 - z.fraction);
    const float* stored = &grid::values[grid::offset(largest, z.node + k, third.node + j, second.node + i)];
    sum += weight * Vec3{stored[0], stored[1], stored[2]};
  }
  return sum;
}

}  // namespace

SigmoidReflectance upsample(const LinearRgb& rgb) {
  const LinearRgb possible = glm::clamp(rgb, 0.0, 1.0);
  if (possible.x == possible.y && possible.y == possible.z) return grey_sigmoid(possible.x);
  const sigmoid::Share share = sigmoid::share_of(possible);
  const LinearRgb& colour = share.rgb;
  const double z = std::max({colour.x, colour.y, colour.z});
  const int largest = colour.x == z ? 0 : colour.y == z ? 1 : 2;
  const Place second = place_of_ratio(colour[(largest + 1) % 3] / z);
  const Place third = place_of_ratio(colour[(largest + 2) % 3] / z);
  const Vec3 k = interpolate(static_cast<std::size_t>(largest), place_of_brightness(z), third, second);
  return sigmoid::reflectance_of(share, {k.x, k.y, k.z});
}

}  // namespace backlight
