// Where the table of sigmoid coefficients has its nodes.
//
// A colour is reduced, as in Jakob & Hanika 2019, to its largest component z, and the other two divided by z.
// Only shares are looked up (sigmoid_fit.h), so that z is between 1/2 and 1.
#pragma once

#include <array>
#include <cstddef>

namespace backlight::upsampling_grid {

inline constexpr std::size_t brightness_nodes = 16;
inline constexpr std::size_t ratio_nodes = 32;
inline constexpr std::size_t value_count = 3 * brightness_nodes * ratio_nodes * ratio_nodes * 3;

/// Nodes of z: from 1/2 to 1 by a smooth step, denser at both ends.
constexpr std::array<double, brightness_nodes> make_brightness() {
  std::array<double, brightness_nodes> nodes{};
  for (std::size_t k = 0; k < brightness_nodes; ++k) {
    const double u = static_cast<double>(k) / (brightness_nodes - 1);
    nodes[k] = 0.5 + 0.5 * (0.9 * (u * u * (3.0 - 2.0 * u)) + 0.1 * u);
  }
  nodes.back() = 1.0;
  return nodes;
}
inline constexpr std::array<double, brightness_nodes> brightness = make_brightness();

/// Node `i` of a ratio is at (i / (ratio_nodes - 1))^2: denser towards saturated colours.
constexpr double ratio(std::size_t i) {
  const double root = static_cast<double>(i) / (ratio_nodes - 1);
  return root * root;
}

/// Where the three coefficients begin: `largest` is the component with the value z; `second` the node of the
/// ratio of the component after it in the cycle red, green, blue; `third` that of the one after that.
constexpr std::size_t offset(std::size_t largest, std::size_t level, std::size_t third, std::size_t second) {
  return (((largest * brightness_nodes + level) * ratio_nodes + third) * ratio_nodes + second) * 3;
}

/// The generated table, written by generate_upsampling_table.cpp.
extern const std::array<float, value_count> values;

}  // namespace backlight::upsampling_grid
